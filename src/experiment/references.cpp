// SPDX-License-Identifier: Apache-2.0
#include "experiment/references.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/number.h"
#include "dcnn/experiment/evaluate.h"
#include "dcnn/experiment/train.h"
#include "experiment/markup.h"

namespace dcnn {
namespace {

constexpr double kTie = 1.01;  // errors within 1 % are called equal

/// Mean of model over reference, so that targets of several units count alike.
double mean_ratio(const std::vector<double>& rmse, const std::vector<double>& reference) {
  double sum = 0.0;
  for (std::size_t j = 0; j < rmse.size(); ++j) sum += rmse[j] / std::max(reference[j], 1e-300);
  return sum / static_cast<double>(rmse.size());
}

bool is_whole_wrench(const Targets& targets) {
  return targets.names == std::vector<std::string>{"fx", "fy", "fz", "tx", "ty", "tz"};
}

/// "fx is predicted worse than by zero (1.5 against 1 N), fz (2 against 1 N)"; empty where none is.
std::string worse_than_zero(const std::vector<double>& rmse, const References& references,
                            const Targets& targets) {
  std::string text;
  for (std::size_t j = 0; j < rmse.size(); ++j) {
    if (!(rmse[j] > kTie * references.none[j])) continue;
    text += (text.empty() ? "" : ", ") + targets.names[j] +
            (text.empty() ? " is predicted worse than by zero (" : " (") + significant(rmse[j], 3) +
            " against " + significant(references.none[j], 3) + " " + unit_text(targets.units[j]) +
            ")";
  }
  return text.empty() ? text : text + ": of no use there";
}

/// Whether two errors are called equal on every target.
bool are_equal(const Score& a, const Score& b) {
  for (std::size_t j = 0; j < a.rmse.size(); ++j) {
    if (a.rmse[j] > kTie * b.rmse[j] || b.rmse[j] > kTie * a.rmse[j]) return false;
  }
  return true;
}

}  // namespace

std::string form_in_words(const Targets& targets) {
  return is_whole_wrench(targets) ? "as one body (mass, centre, inertia, offset; the form inertial)"
                                  : "by regression on its terms, without added noise";
}

std::vector<double> white_noise(const Eigen::MatrixXd& measured) {
  std::vector<double> all;
  const Eigen::Index n = measured.rows() - 3;
  for (Eigen::Index j = 0; j < measured.cols(); ++j) {
    if (n < 1) {
      all.push_back(0.0);
      continue;
    }
    const auto x = measured.col(j);
    const Eigen::VectorXd third =
        (x.segment(3, n) - 3.0 * x.segment(2, n) + 3.0 * x.segment(1, n) - x.segment(0, n))
            .cwiseAbs();
    std::vector<double> sorted(third.begin(), third.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    all.push_back(*middle / (0.6745 * std::sqrt(20.0)));
  }
  return all;
}

Identifier fit_rigid(const Identifier& like, const Samples& training, const Samples& validation) {
  Identifier rigid;
  rigid.name = "rigid";
  rigid.layout = like.layout;
  rigid.targets = like.targets;
  rigid.base = like.base;
  rigid.seed = like.seed;
  const bool whole =
      like.layout.system.kind == System::Kind::kWrist && is_whole_wrench(like.targets);
  const ModelKind& kind = model_kind("rigid", Exit::kFailure);
  rigid.configuration =
      merged(kind.preset("standard", like.layout.system.kind == System::Kind::kAxes),
             {{"model", {{"name", "rigid"}, {"form", whole ? "inertial" : "regression"}}}});
  try {
    auto model = kind.make({rigid.layout, rigid.targets, rigid.configuration, "the rigid tool",
                            rigid.seed, rigid.base.has_value()});
    FitSession session;
    model->fit(training, validation, session);
    rigid.model = std::move(model);
  } catch (const Error&) {
    rigid.model = nullptr;  // too few or too poor rows, or another machine
  }
  return rigid;
}

std::filesystem::path rigid_file(const std::filesystem::path& model) {
  return run_directory(model) / "rigid.dcnn";
}

std::vector<std::string> warnings(const std::string& model, const std::vector<double>& rmse,
                                  const References& references, const Targets& targets) {
  std::string line = worse_than_zero(rmse, references, targets);
  const double ratio = references.rigid.empty() ? 0.0 : mean_ratio(rmse, references.rigid);
  if (ratio > kTie) {
    line += (line.empty() ? "its error is " : "; its error is ") + significant(ratio, 3) +
            " times that of the rigid tool " + form_in_words(targets) +
            (targets.names.size() > 1 ? ", by the mean of the targets' ratios" : "") +
            (references.rigid_file.empty() ? "" : ", which is " + references.rigid_file) +
            "; dcnn-train --model auto keeps the better one";
  } else if (!line.empty()) {
    line += "; try dcnn-train --model auto";
  }
  if (line.empty()) return {};
  return {model + ": " + line};
}

const Score* rigid_of(const EvaluationSummary& summary, const Evaluation& evaluation) {
  for (const RigidReference& rigid : evaluation.references.rigid) {
    if (rigid.file == summary.rigid_file) return &rigid.score;
  }
  return nullptr;
}

void judge_by_rigid_tools(const std::vector<std::filesystem::path>& models,
                          const std::vector<Json>& derivatives, Evaluation& evaluation) {
  const std::size_t each = evaluation.summary.size() / models.size();
  for (std::size_t i = 0; i < models.size(); ++i) {
    const std::string own = rigid_file(models[i]).string();
    std::string file;
    for (const RigidReference& rigid : evaluation.references.rigid) {
      if (rigid.file == own) file = own;
      if (file.empty() && rigid.derivative == derivatives[i]) file = rigid.file;
    }
    for (std::size_t k = 0; k < each; ++k) evaluation.summary[i * each + k].rigid_file = file;
  }
}

std::vector<ShownRigid> shown_rigid_tools(const Evaluation& evaluation) {
  std::vector<const RigidReference*> shown;
  for (const RigidReference& rigid : evaluation.references.rigid) {
    const bool known = std::any_of(shown.begin(), shown.end(), [&](const RigidReference* other) {
      return are_equal(rigid.score, other->score);
    });
    if (!known) shown.push_back(&rigid);
  }
  std::vector<ShownRigid> rows;
  for (const RigidReference* rigid : shown) {
    const std::filesystem::path folder = std::filesystem::path(rigid->file).parent_path();
    rows.push_back(
        {shown.size() == 1 ? "rigid tool" : "rigid tool of " + folder.filename().string(),
         rigid->score});
  }
  return rows;
}

void note_missing_rigid(const std::vector<std::filesystem::path>& models, Evaluation& evaluation) {
  const bool is_evaluated =
      std::any_of(evaluation.summary.begin(), evaluation.summary.end(),
                  [](const EvaluationSummary& s) { return s.model == "rigid"; });
  if (is_evaluated) return;
  const std::size_t each = evaluation.summary.size() / models.size();
  std::size_t i = 0;
  while (i < models.size() && (!evaluation.summary[i * each].rigid_file.empty() ||
                               std::filesystem::exists(run_directory(models[i])))) {
    ++i;
  }
  if (i == models.size()) return;
  const std::filesystem::path& model = models[i];
  evaluation.notes.push_back(
      model.string() + ": the rigid tool that dcnn-train fitted beside it, " +
      rigid_file(model).string() + ", is missing, so it is not compared; copy " +
      run_directory(model).filename().string() +
      " beside the model, or train one by dcnn-train --model rigid and name "
      "it here, too");
}

void add_warnings(Evaluation& evaluation) {
  EvaluationReferences& references = evaluation.references;
  for (const EvaluationSummary& s : evaluation.summary) {
    if (s.snr_db) continue;
    References beside{evaluation.unidentified.rmse, {}, references.noise, s.rigid_file};
    if (const Score* rigid = rigid_of(s, evaluation)) beside.rigid = rigid->rmse;
    const auto lines = warnings(s.file, s.first.rmse, beside, evaluation.targets);
    references.warnings.insert(references.warnings.end(), lines.begin(), lines.end());
  }
}

Json to_json(const References& references) {
  return {{"none", references.none},
          {"rigid", references.rigid.empty() ? Json() : Json(references.rigid)},
          {"white_noise", references.noise}};
}

}  // namespace dcnn
