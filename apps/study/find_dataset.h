// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "io/pairs/dataset_file.h"

namespace corral {

/// The data set of an experiment: the folder itself if it is a data set, else its subfolder of that name. Throws IoError.
Dataset find_dataset(const std::string& data_folder, const std::string& name, const std::string& experiment);

}  // namespace corral
