// SPDX-License-Identifier: Apache-2.0
// Logs of ROS: MCAP (https://mcap.dev/spec), ROS 1 bags (format 2.0), rosbag2's SQLite files.
#pragma once

#include <filesystem>

#include "import/log_builder.h"

namespace dcnn {

void read_mcap(const std::filesystem::path& path, LogBuilder& builder);
void read_bag(const std::filesystem::path& path, LogBuilder& builder);
void read_db3(const std::filesystem::path& path, LogBuilder& builder);

/// NumPy: one array, or a zip file of arrays.
void read_npy(const std::filesystem::path& path, const std::string& name, LogBuilder& builder);
void read_npz(const std::filesystem::path& path, LogBuilder& builder);

/// MATLAB, v5 to v7.3, read by libmatio in a process of its own that can open no other file.
void read_mat(const std::filesystem::path& path, LogBuilder& builder);

}  // namespace dcnn
