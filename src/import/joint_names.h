// SPDX-License-Identifier: Apache-2.0
// Columns of an arm's joints by their names.
#pragma once

#include <string>
#include <vector>

namespace dcnn {

/// "q:", "qd:" or "tau:" by a file's name, in words: {pos, read, data}; empty where it says
/// nothing or two things.
std::string joint_quantity_of_file(const std::vector<std::string>& words);

/// True where a word says that the name is one of a joint: {joint, 3}, {joint3}, {axis, 2, speed}.
bool names_joint(const std::vector<std::string>& words);

/// "q:NAME", "qd:NAME", "tau:NAME" by words in any order: {pos, panda, joint1}, {actual, q, 0},
/// {arm, 2, joint, effort}; "current:NAME" of a motor's current. A name without a quantity has that
/// of its file, `of_file`. Empty where the words are no joint's.
std::string joint_role(const std::vector<std::string>& words, const std::string& of_file);

/// "q:", "qd:" or "tau:" where the words are one quantity and nothing else, as the only joint of a
/// log is called: {q}, {measured, torque}; "current:" of a current. Else empty.
std::string lone_quantity(const std::vector<std::string>& words);

}  // namespace dcnn
