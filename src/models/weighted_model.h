// SPDX-License-Identifier: Apache-2.0
// A model that adds to a simulator, weighted by how far it proved itself where it did not learn.
#pragma once

#include <memory>

#include "dcnn/models/model.h"

namespace dcnn {

/// (targets) in [0, 1]: by how much to multiply predictions of what a simulator leaves, so that the
/// least is left of the validation samples, shrunk as far as blocks of them disagree (positive-part
/// James-Stein with twice the standard error): 0 where nothing shows that they help. `block` rows
/// are taken to be independent of the next ones. 1 without validation rows.
Eigen::VectorXd trust(const Samples& validation, const Eigen::MatrixXd& predicted, Index block);

/// `model` with every prediction multiplied by the weight of its target.
std::unique_ptr<Model> weighted(std::unique_ptr<Model> model, const Eigen::VectorXd& weights);
/// The same with the weights that save() of such a model left in the file, if it did; `targets` is
/// how many the model predicts.
std::unique_ptr<Model> with_stored_weights(std::unique_ptr<Model> model, Index targets,
                                           const Container& file, const std::string& where);

}  // namespace dcnn
