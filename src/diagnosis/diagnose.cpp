#include "dcnn/diagnosis/diagnose.h"

#include "diagnosis/load.h"
#include "diagnosis/search.h"

namespace dcnn {

Json diagnose(const DiagnosisRequest& request,
              const std::function<void(const std::string&)>& progress) {
  LoadedCase loaded = load_wrist(request);
  Search search(std::move(loaded.fit), {}, progress);
  search.run();
  Json report;
  report["cutoff_hz"] = search.study().derivative.cutoff_hz;
  report["chi2_before"] = search.chi2_before();
  report["chi2"] = search.fit().chi2;
  report["rows"] = search.fit().residual.size();
  for (const Floor& floor : search.floors()) {
    report["floor"].push_back({floor.deviation(), floor.rho, floor.moving_part});
  }
  report["findings"] = to_json(specs_of(search.fit().members));
  return report;
}

}  // namespace dcnn
