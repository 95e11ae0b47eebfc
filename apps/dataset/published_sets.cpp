// SPDX-License-Identifier: MIT
#include "apps/dataset/published_sets.h"

#include "apps/runtime/embedded_files.h"
#include "io/text/toml_file.h"

namespace corral {

const EmbeddedFiles& embedded_data();

std::vector<PublishedSet> published_sets() {
  std::vector<PublishedSet> sets;
  for (const char* name : {"default", "b3r", "stanford", "u3m", "u3or", "3dmatch", "eth-tls", "kitti"}) {
    const std::string file = std::string(name) + ".toml";
    const TomlTable table = TomlTable::parse("data/" + file, embedded_data().at(file));
    const auto text = [&](const char* key) {
      const auto value = table.text(key);
      if (!value) table.fail(key, "is missing");
      return *value;
    };
    PublishedSet set{name,
                     text("title"),
                     text("origin"),
                     text("place"),
                     text("terms"),
                     table.texts("citation"),
                     table.texts("layout"),
                     table.texts("files"),
                     {},
                     text("use")};
    for (const TomlTable& known : table.tables("known"))
      set.known.push_back({known.text("name").value(), known.text("package").value(), known.text("sha256").value()});
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace corral
