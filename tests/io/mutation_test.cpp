// SPDX-License-Identifier: MIT
// Damaged files of every format: a reader either refuses them or gives something valid, and never does anything else.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/disk/inflate.h"
#include "io/matches/group_file.h"
#include "io/matches/matches_file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/pose_entry.h"
#include "io/pose/transform_file.h"
#include "kernel/random.h"
#include "kernel/synthetic.h"
#include "tests/io/disk/gzip.h"
#include "tests/io/mesh/pcd_encoder.h"
#include "tests/io/mesh/ply_encoder.h"
#include "tests/io/scratch.h"

namespace corral {
namespace {

using testing::put_text;
using testing::ScratchFolder;

constexpr int kRounds = 2000;

enum class Damage { Flip, Insert, Delete };

/// One to three bytes damaged; half of what is put in comes from the alphabet of the text formats.
std::string damaged(std::string content, Damage damage, RandomStream& random) {
  const std::string alphabet = "0123456789-+.eE ,\n#nanif";
  for (std::uint64_t left = 1 + random.below(3); left > 0 && !content.empty(); --left) {
    const std::size_t at = random.below(content.size());
    const char byte =
        random.below(2) == 0 ? alphabet[random.below(alphabet.size())] : static_cast<char>(random.below(256));
    if (damage == Damage::Flip) content[at] = byte;
    if (damage == Damage::Insert) content.insert(at, 1, byte);
    if (damage == Damage::Delete) content.erase(at, 1);
  }
  return content;
}

/// `read` must return or throw one of the two errors that a user understands. Returns how often it accepted.
int survive(const std::string& content, std::uint64_t seed, const std::function<void(const std::string&)>& read) {
  RandomStream random(seed);
  int accepted = 0;
  for (const Damage damage : {Damage::Flip, Damage::Insert, Damage::Delete}) {
    for (int round = 0; round < kRounds; ++round) {
      const std::string bad = damaged(content, damage, random);
      try {
        read(bad);
        ++accepted;
      } catch (const IoError&) {
      } catch (const InvalidInput&) {
      } catch (const std::exception& error) {
        ADD_FAILURE() << "damage " << static_cast<int>(damage) << ", round " << round << ": " << error.what();
        return accepted;
      }
    }
  }
  EXPECT_GT(accepted, 0) << "the damage is too coarse: nothing behind the first check is reached";
  EXPECT_LT(accepted, 3 * kRounds) << "no damage is ever seen";
  return accepted;
}

void survive_as_mesh(const std::string& content, std::uint64_t seed,
                     StoredMesh (*parse)(const std::string&, std::string_view)) {
  ASSERT_NO_THROW(parse("mesh", content).validate("undamaged"));
  survive(content, seed, [parse](const std::string& bad) {
    const Mesh mesh = parse("mesh", bad);
    EXPECT_NO_THROW(mesh.validate("damaged")) << bad;
  });
}

TEST(Mutation, Off) {
  survive_as_mesh("OFF\n4 2 5\n0 0 0.5\n1 0 .5\n1 1e0 0.5\n0 1 0.5\n3 0 1 2\n4 0 1 2 3\n", 1, parse_off);
}

TEST(Mutation, Obj) {
  survive_as_mesh("# by hand\nv 0 0 0.5\nv 1 0 0.5\nv 1 1 0.5\nv 0 1 0.5\nvn 0 0 1\nf 1/1 2//1 3/1/1\nf -4 -2 -1\n", 2,
                  parse_obj);
}

TEST(Mutation, PlyAscii) { survive_as_mesh(testing::intricate_ply("ascii"), 3, parse_ply); }
TEST(Mutation, PlyLittleEndian) { survive_as_mesh(testing::intricate_ply("binary_little_endian"), 4, parse_ply); }
TEST(Mutation, PlyBigEndian) { survive_as_mesh(testing::intricate_ply("binary_big_endian"), 5, parse_ply); }

TEST(Mutation, PlyStripsAndGrid) {
  const std::string vertices =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
      "property float ny\nproperty float nz\n";
  const std::string lists =
      "element tristrips 1\nproperty list int int vertex_indices\nelement range_grid 6\n"
      "property list uchar int vertex_indices\n";
  std::vector<testing::PlyRow> rows;
  for (int i = 0; i < 4; ++i)
    rows.push_back({{'f', i % 2 * 1.0}, {'f', i / 2 * 1.0}, {'f', 0.5}, {'f', 0}, {'f', 0}, {'f', 1}});
  rows.push_back({{'i', 5}, {'i', 0}, {'i', 1}, {'i', 2}, {'i', 3}, {'i', -1}});
  for (int cell = 0; cell < 6; ++cell)
    rows.push_back(cell % 3 == 2 ? testing::PlyRow{{'B', 0}}
                                 : testing::PlyRow{{'B', 1}, {'i', cell / 3 * 2.0 + cell % 3}});
  for (const std::string& format : testing::kPlyFormats)
    survive_as_mesh(testing::ply_file(format, "obj_info num_cols 3\nobj_info num_rows 2\n" + vertices + lists, rows),
                    15, parse_ply);
}

TEST(Mutation, StlText) {
  survive_as_mesh(
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.5\nvertex 1 0 0.5\nvertex 1 1 0.5\nendloop\nendfacet\n"
      "endsolid a\n",
      10, parse_stl);
}

TEST(Mutation, StlBinary) {
  std::string content(80, ' ');
  content += testing::encode({'I', 2}, false);
  for (int facet = 0; facet < 2; ++facet) {
    for (int i = 0; i < 12; ++i) content += testing::encode({'f', (i * 5 + facet) % 4 - 1.5}, false);
    content += std::string(2, '\0');
  }
  survive_as_mesh(content, 11, parse_stl);
}

TEST(Mutation, Xyz) { survive_as_mesh("# by hand\n0 0 0.5\n1 0 .5\n1 1e0 0.5\n0,1,0.5\n", 12, parse_xyz); }
TEST(Mutation, ListWithNames) { survive_as_mesh("//id;X;Y;Z\n3\n1;0;0;0.5\n2;1;0;.5\n3;1;1e0;0.5\n", 16, parse_xyz); }
TEST(Mutation, ObjOfOthers) {
  survive_as_mesh("vn 0 0 1\nv 0 0 0.5 # a\nv 1 0 0.5\nv 1 1 0.5\nvp 0 1\nvn 0 1 0\nf 1//1 2//2 \\\n3//-1\n", 17,
                  parse_obj);
}
TEST(Mutation, OffWithNormals) {
  survive_as_mesh(
      "NCOFF3 1 0 # v f e\n0 0 0.5 255 0 0 255 0 0 1\n1 0 .5 1 2 3 4 0 0 2\nnan 1e0 0.5 0 0 0 0 0 0 1\n3 0 1 2", 18,
      parse_off);
}
TEST(Mutation, PcdCompressed) {
  // Literal runs: a byte with the length less one, then the bytes.
  std::string packed;
  for (int axis = 0; axis < 3; ++axis) {
    packed += '\x07';
    for (int point = 0; point < 2; ++point) packed += testing::encode({'f', axis + 0.5 * point}, false);
  }
  testing::PcdEntries entries;
  entries.width = entries.points = "2";
  survive_as_mesh(entries.text() + "DATA binary_compressed\n" +
                      testing::encode({'I', static_cast<double>(packed.size())}, false) +
                      testing::encode({'I', 24}, false) + packed,
                  19, parse_pcd);
}
TEST(Mutation, Gzip) {
  const std::string whole = testing::gzipped("OFF\n3 1 0\n0 0 0.5\n1 0 .5\n1 1e0 0.5\n3 0 1 2\n");
  survive(whole, 20, [](const std::string& bad) { inflated("mesh", bad); });
}

TEST(Mutation, PcdText) { survive_as_mesh(testing::intricate_pcd(false), 13, parse_pcd); }
TEST(Mutation, PcdBinary) { survive_as_mesh(testing::intricate_pcd(true), 14, parse_pcd); }

TEST(Mutation, Matches) {
  SyntheticOptions options;
  options.matches = 3;
  const ScratchFolder folder;
  const std::string path = folder / "matches.csv";
  survive(matches_text(make_synthetic_problem(options).matches), 6, [&](const std::string& bad) {
    const CorrespondenceSet matches = read_matches(put_text(path, bad));
    EXPECT_NO_THROW(matches.validate()) << bad;
  });
}

TEST(Mutation, Group) {
  const ScratchFolder folder;
  const std::string path = folder / "group.csv";
  survive(group_text({6, {0, 3, 5}, {0.5, 1, -2, 3e-5, 0, 7}}), 7, [&](const std::string& bad) {
    const GroupTable group = read_group(put_text(path, bad));
    EXPECT_TRUE(group.scores.empty() || group.scores.size() == static_cast<std::size_t>(group.matches)) << bad;
    for (const int row : group.selected) EXPECT_TRUE(row >= 0 && row < group.matches) << bad;
  });
}

/// Whatever is accepted is rigid.
void survive_as_poses(const std::string& content, std::uint64_t seed) {
  survive(content, seed, [](const std::string& bad) {
    for (const PoseEntry& entry : parse_poses("pose", bad)) {
      const RigidTransform pose = rigid_pose("pose", entry);
      EXPECT_TRUE(is_rotation(pose.rotation, 1e-4)) << bad;
      EXPECT_TRUE(pose.translation.allFinite()) << bad;
    }
  });
}

TEST(Mutation, Transform) {
  RandomStream random(8);
  const RigidTransform motion{random.rotation(), random.direction()};
  for (std::size_t i = 0; i < choice_names(TransformLayout()).size(); ++i) {
    const auto layout = static_cast<TransformLayout>(i);
    const std::string text = transform_text(motion, layout);
    const bool has_several = layout == TransformLayout::Kitti || layout == TransformLayout::Tum ||
                             layout == TransformLayout::Log || layout == TransformLayout::Conf;
    survive_as_poses(text, 9 + i);
    if (has_several) survive_as_poses(text + transform_text(motion.inverse(), layout), 29 + i);
  }
}

}  // namespace
}  // namespace corral
