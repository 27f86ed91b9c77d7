// SPDX-License-Identifier: Apache-2.0
#include "models/shallow_input.h"

#include <algorithm>
#include <numeric>

#include "models/tensor_io.h"

namespace dcnn {
namespace {

bool is_angle(const std::string& name) {
  static const std::vector<std::string> kOrientation{"alpha", "beta", "gamma", "ux", "uy", "uz"};
  return std::ranges::find(kOrientation, name) != kOrientation.end() || name.ends_with("_position");
}

std::vector<Index> angles(const Options& model, const FeatureLayout& layout) {
  std::vector<Index> columns;
  for (std::size_t j = 0; j < layout.names.size(); ++j) {
    if (is_angle(layout.names[j])) columns.push_back(static_cast<Index>(j));
  }
  if (columns.empty()) model.reject("inputs", "is 'angles', but there is no angle; use 'all'");
  return columns;
}

std::vector<Index> named(const Options& model, const Json& list, const FeatureLayout& layout) {
  std::vector<Index> columns;
  for (const Json& item : list) {
    const auto name = item.is_string() ? item.get<std::string>() : item.dump();
    const auto found = std::ranges::find(layout.names, name);
    if (found == layout.names.end()) {
      const auto near = nearest_word(name, layout.names);
      model.reject("inputs", "names '", name, "', which is no feature",
                   near.empty() ? "" : "; did you mean '" + near + "'?");
    }
    columns.push_back(found - layout.names.begin());
  }
  std::ranges::sort(columns);
  if (columns.empty() || std::ranges::adjacent_find(columns) != columns.end()) {
    model.reject("inputs", "must name at least one feature, and none twice");
  }
  return columns;
}

std::vector<Index> chosen(Options& model, const FeatureLayout& layout) {
  const Json inputs = model.raw("inputs");
  const auto count = static_cast<Index>(layout.names.size());
  if (inputs.is_null() || inputs == "all") return all_rows(count);
  if (inputs == "angles") return angles(model, layout);
  if (!inputs.is_array()) {
    model.reject("inputs", "must be 'all', 'angles' or a list of features, not ", inputs.dump());
  }
  return named(model, inputs, layout);
}

}  // namespace

std::vector<Index> all_rows(Index n) {
  std::vector<Index> rows(static_cast<std::size_t>(n));
  std::iota(rows.begin(), rows.end(), Index{0});
  return rows;
}

ShallowInput::ShallowInput(Options& model, const FeatureLayout& layout, const std::string& where)
    : columns_(chosen(model, layout)) {
  const Json input = model.raw("input");
  if (input.is_null()) return;
  const auto features = static_cast<Index>(layout.names.size());
  if (count() != features) model.reject("inputs", "chooses features; leave it or 'input' out");
  input_ = make_input(input, layout, where);
  columns_ = all_rows(available(features));
}

ShallowInput::ShallowInput(const Container& file, Index features, const std::string& where)
    : least_(stored_row(file, "input_least", where)), most_(stored_row(file, "input_most", where)) {
  const Json input = parse_json(stored_text(file, "input", where), where, Exit::kModel);
  if (!input.is_null()) input_ = stored_input(input, features, where);
  const auto& columns = stored_values<std::int64_t>(file, "input_columns", where);
  columns_.assign(columns.begin(), columns.end());
  require(!columns_.empty() && columns_.front() >= 0 && columns_.back() < available(features) &&
              std::ranges::adjacent_find(columns_, std::greater_equal<>()) == columns_.end() &&
              least_.size() == count() && most_.size() == count() &&
              (least_.array() < most_.array()).all(),
          Exit::kModel, where, ": its inputs do not fit its features");
}

/// Columns there are to choose from.
Index ShallowInput::available(Index features) const {
  return input_ ? element_count(input_->shape()) : features;
}

RowMatrix ShallowInput::raw(const Stream& stream, const InputMap& map,
                            const std::vector<Index>& rows) const {
  const auto n = static_cast<Index>(rows.size());
  RowMatrix values(n, count());
  if (!input_) {
    for (Index i = 0; i < n; ++i) {
      values.row(i) = stream.x(rows[static_cast<std::size_t>(i)], columns_);
    }
    return values;
  }
  const PreparedStream prepared = input_->prepare(stream, map);
  std::vector<Real> sample(static_cast<std::size_t>(element_count(input_->shape())));
  for (Index i = 0; i < n; ++i) {
    input_->write(prepared, map, rows[static_cast<std::size_t>(i)], sample.data());
    for (Index j = 0; j < count(); ++j) {
      const Index column = columns_[static_cast<std::size_t>(j)];
      values(i, j) = static_cast<double>(sample[static_cast<std::size_t>(column)]);
    }
  }
  return values;
}

void ShallowInput::learn(const Samples& training, const InputMap& map, const NoiseSpec& noise) {
  if (input_) input_->learn(training, map, noise);
  const RowMatrix values = raw(training, map, all_rows(training.rows()));
  const Eigen::RowVectorXd least = values.colwise().minCoeff(), most = values.colwise().maxCoeff();
  std::vector<Index> kept;
  for (Index j = 0; j < count(); ++j) {
    // Beyond rounding: what does not vary would otherwise be stretched to full range.
    if (most[j] - least[j] > 1e-12 * std::max(1.0, std::abs(most[j]))) kept.push_back(j);
  }
  require(!kept.empty(), Exit::kData,
          "every input is constant over the training rows; record a motion that turns the tool");
  least_ = least(kept);
  most_ = most(kept);
  for (Index& j : kept) j = columns_[static_cast<std::size_t>(j)];
  columns_ = kept;
}

RowMatrix ShallowInput::read(const Stream& stream, const InputMap& map,
                             const std::vector<Index>& rows) const {
  RowMatrix values = raw(stream, map, rows);
  values.rowwise() -= least_;
  values.array().rowwise() *= 2.0 / (most_ - least_).array();
  values.array() -= 1.0;
  return values;
}

ShallowInput::Streaming::Streaming(const ShallowInput& input, const InputMap& map)
    : columns_(input.columns_),
      least_(input.least_),
      scale_(2.0 / (input.most_ - input.least_).array()) {
  if (input.input_) input_ = input.input_->streaming(map);
}

void ShallowInput::Streaming::reset() noexcept {
  if (input_) input_->reset();
}

void ShallowInput::Streaming::push(const Eigen::VectorXd& x, Eigen::RowVectorXd& signals) noexcept {
  const Real* cells = input_ ? input_->push(x) : nullptr;
  for (Index j = 0; j < least_.size(); ++j) {
    const Index column = columns_[static_cast<std::size_t>(j)];
    const double value = cells ? static_cast<double>(cells[column]) : x[column];
    signals[j] = (value - least_[j]) * scale_[j] - 1.0;
  }
}

void ShallowInput::save(Container& file) const {
  file.metadata["input"] = (input_ ? input_->to_json() : Json()).dump();
  file.tensors.push_back({"input_columns", {count()}, columns_});
  file.tensors.push_back(
      {"input_least", {count()}, std::vector<double>(least_.begin(), least_.end())});
  file.tensors.push_back(
      {"input_most", {count()}, std::vector<double>(most_.begin(), most_.end())});
}

}  // namespace dcnn
