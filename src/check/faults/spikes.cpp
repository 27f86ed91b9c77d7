#include "data/spikes.h"

#include "check/rows.h"

namespace dcnn::check {
namespace {

void find_spikes_in(const Log& log, const std::string& name, std::vector<Fault>& out) {
  const Spikes spikes = spikes_of(log.column(name));
  if (spikes.rows.empty()) return;
  Fault fault = fault_of(spikes_fault, posterior_of_p(spikes.p), name, spikes.words(name));
  set_interval(log, spikes.rows.front(), spikes.rows.front() + 1, fault);
  out.push_back(fault);
}

std::vector<Fault> find_spikes(const Evidence& e) {
  std::vector<Fault> out;
  if (!e.log.smooth) return out;
  for (const std::string& name : measured_columns(e.log)) find_spikes_in(e.log, name, out);
  return out;
}

}  // namespace

const FaultKind spikes_fault{"spikes", false, "remove these rows", "", find_spikes};

}  // namespace dcnn::check
