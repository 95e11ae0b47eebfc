// SPDX-License-Identifier: MIT
#include "apps/pair/option_names.h"

#include "apps/pair/methods.h"
#include "kernel/surface/registry.h"

namespace corral {

std::vector<std::string> option_names() {
  std::vector<std::string> names;
  for (const Grouper& entry : methods()) names.push_back(entry.name);
  for (const Detector& entry : detectors()) names.push_back(entry.name);
  for (const Descriptor& entry : descriptors()) names.push_back(entry.name);
  return names;
}

const std::vector<OptionValue>* default_options(const std::string& name) {
  if (const Grouper* entry = look_up(methods(), name)) return &entry->options;
  if (const Detector* entry = look_up(detectors(), name)) return &entry->options;
  if (const Descriptor* entry = look_up(descriptors(), name)) return &entry->options;
  return nullptr;
}

std::pair<std::string, std::string> split_option(const std::string& option) {
  const std::size_t dot = option.find('.');
  return {option.substr(0, dot), option.substr(dot + 1)};
}

}  // namespace corral
