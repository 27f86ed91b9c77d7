// SPDX-License-Identifier: Apache-2.0
// The C interface: no exception and no C++ type crosses it.
#include "dcnn.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>

#include "dcnn/runtime/open.h"

struct dcnn_tool {
  dcnn::OnlineCompensator compensator;
  dcnn::OnlineResult result = {};
  bool rearm = false;
};

namespace {

void tell(const char* text, char* error, size_t error_size) {
  if (!error || error_size == 0) return;
  const size_t length = std::min(std::strlen(text), error_size - 1);
  std::memcpy(error, text, length);
  error[length] = '\0';
}

void copy(const dcnn::Vector6d& from, double* to) {
  if (to) std::copy(from.begin(), from.end(), to);
}

}  // namespace

const char* dcnn_version(void) { return DCNN_VERSION; }

dcnn_tool* dcnn_open(const char* model, const char* fallback, const char* calibration, char* error,
                     size_t error_size) {
  try {
    dcnn::require(model, dcnn::Exit::kUsage, "no model is named");
    const dcnn::OnlineFiles files{model, fallback ? fallback : "", calibration ? calibration : ""};
    return new dcnn_tool{dcnn::open_compensator(files, {}, [](const std::string&) {})};
  } catch (const std::exception& failure) {
    tell(failure.what(), error, error_size);
    return nullptr;
  }
}

void dcnn_close(dcnn_tool* handle) { delete handle; }

int dcnn_step(dcnn_tool* handle, double t, const double* position, const double* quaternion,
              const double* wrench, double* own, double* external) {
  if (!handle || !position || !quaternion) return -1;
  dcnn::OnlineSample sample;
  sample.t = t;
  sample.position = Eigen::Map<const Eigen::Vector3d>(position);
  sample.quaternion = Eigen::Map<const Eigen::Vector4d>(quaternion);
  if (wrench) sample.wrench = Eigen::Map<const dcnn::Vector6d>(wrench);
  sample.rearm = handle->rearm;
  handle->rearm = false;
  handle->result = handle->compensator.step(sample);
  copy(handle->result.tool, own);
  copy(handle->result.external, external);
  return static_cast<int>(handle->result.state);
}

int dcnn_miss(dcnn_tool* handle, double* external) {
  if (!handle) return -1;
  handle->result = handle->compensator.miss();
  copy(handle->result.external, external);
  return static_cast<int>(handle->result.state);
}

void dcnn_rearm(dcnn_tool* handle) {
  if (handle) handle->rearm = true;
}

double dcnn_sample_time(const dcnn_tool* handle) { return handle ? handle->compensator.dt() : 0.0; }

int dcnn_has_torque(const dcnn_tool* handle) { return handle && handle->compensator.has_torque(); }

int dcnn_contact(const dcnn_tool* handle) { return handle && handle->result.contact; }

double dcnn_novelty(const dcnn_tool* handle) { return handle ? handle->result.novelty : 0.0; }

const char* dcnn_state_name(int state) {
  if (state < DCNN_WARMUP || state > DCNN_FAULT) return "unknown";
  return dcnn::name_of(static_cast<dcnn::RunState>(state));
}

const char* dcnn_reason(const dcnn_tool* handle) {
  return dcnn::name_of(handle ? handle->result.reason : dcnn::Reason::kNone);
}
