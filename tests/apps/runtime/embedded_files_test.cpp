// SPDX-License-Identifier: MIT
#include "apps/runtime/embedded_files.h"

#include <gtest/gtest.h>

#include "tests/io/scratch.h"

namespace corral {

const EmbeddedFiles& embedded_samples();

namespace {

TEST(EmbeddedFiles, HoldTheFilesToTheByte) {
  EXPECT_EQ(embedded_samples().size(), 2u);
  for (const char* name : {"CMakeLists.txt", "README.md"}) {  // backslashes, quotes, ${}, ;, letters beyond ASCII
    const std::string text = testing::text_of(std::string(CORRAL_SOURCE_DIR "/") + name);
    EXPECT_GT(text.size(), 1000u);
    EXPECT_TRUE(embedded_samples().at(name) == text) << name;
  }
}

}  // namespace
}  // namespace corral
