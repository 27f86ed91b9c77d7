// SPDX-License-Identifier: Apache-2.0
// What a stranger's program does with the installed library.
#include <dcnn/models/container.h>

#include <iostream>

int main() {
  dcnn::Container container;
  container.tensors = {{"weight", {2}, std::vector<float>{1, 2}}};
  const auto read = dcnn::decode(dcnn::encode(container), "memory");
  std::cout << read.find("weight")->name << "\n";
}
