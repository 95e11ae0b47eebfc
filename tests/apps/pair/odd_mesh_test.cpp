// SPDX-License-Identifier: MIT
// Surfaces as they come: the whole way from meshes to matches must not fall over any of them, and must say what it met.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/pair/match_pair.h"
#include "apps/pair/match_report.h"
#include "tests/support/meshes.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

using testing::points_of;

Mesh sphere() { return testing::bumpy_sphere(4, 1); }

/// More vertices behind those of a mesh.
Mesh with_vertices(Mesh mesh, const Points& more) {
  mesh.vertices.conservativeResize(mesh.vertices.rows() + more.rows(), 3);
  mesh.vertices.bottomRows(more.rows()) = more;
  return mesh;
}

Mesh with_faces(Mesh mesh, const Triangles& more) {
  mesh.triangles.conservativeResize(mesh.triangles.rows() + more.rows(), 3);
  mesh.triangles.bottomRows(more.rows()) = more;
  return mesh;
}

Mesh cloud(Mesh mesh) {
  mesh.triangles.resize(0, 3);
  return mesh;
}

/// With every detector that can take the mesh, against the sphere; the report is that of harris. Neighbourhoods of
/// harris-mesh are a share of the bounding box: outliers are not for it.
MatchReport match_with_sphere(const Mesh& mesh, bool has_outliers = false) {
  MatchReport report;
  for (const char* detector : {"harris-mesh", "uniform", "harris"}) {
    MatchSettings settings;
    settings.detector = detector;
    settings.inspect = true;
    settings.resolution = "target";
    if (settings.detector == "harris-mesh" && (has_outliers || mesh.triangles.rows() == 0)) continue;
    for (const bool mutual : {true, false}) {
      settings.matching.mutual = mutual;
      const MatchedPair pair = match_pair(mesh, sphere(), settings);
      EXPECT_NO_THROW(pair.matches.validate());
      EXPECT_EQ(pair.matches.size(), pair.report.matches);
      EXPECT_EQ(pair.report.source.points, mesh.vertices.rows());
      EXPECT_EQ(pair.report.source.faces, mesh.triangles.rows());
      EXPECT_TRUE(pair.report.source.topology.has_value() && pair.report.target.topology.has_value());
      const auto& hints = pair.report.hints;
      EXPECT_EQ(pair.report.matches == 0,
                std::any_of(hints.begin(), hints.end(), [](const auto& hint) { return hint.rfind("no ", 0) == 0; }));
      EXPECT_FALSE(stage_report(pair.report).empty());
      EXPECT_FALSE(to_json(pair.report)["source"]["topology"].is_null());
      report = pair.report;
    }
  }
  return report;
}

TEST(OddMeshes, DuplicateVerticesAreCountedAndHarmless) {
  const Mesh mesh = with_vertices(sphere(), sphere().vertices.topRows(500));
  const MatchReport report = match_with_sphere(mesh), clean = match_with_sphere(sphere());
  EXPECT_EQ(report.source.topology->duplicate_vertices, 500);
  EXPECT_EQ(report.source.topology->isolated_vertices, 500);
  EXPECT_EQ(report.source.resolution, clean.source.resolution);
  EXPECT_GT(report.matches, clean.matches / 2);
  EXPECT_THAT(stage_report(report), HasSubstr("500 duplicate vertices, 500 isolated vertices"));
}

TEST(OddMeshes, IsolatedVerticesAreCountedAndHarmless) {
  const Mesh mesh = with_vertices(sphere(), points_of({{40, 0, 0}, {0, 1e7, 0}, {0, 0, -3}}));
  const MatchReport report = match_with_sphere(mesh, true);
  EXPECT_EQ(report.source.topology->isolated_vertices, 3);
  EXPECT_GT(report.matches, 10);
}

TEST(OddMeshes, FacesThatAreNoneAreCountedAndHarmless) {
  Triangles odd(3, 3);
  odd << 5, 5, 6, 7, 8, 7, 0, 2562, 9;  // twice a corner, and one without area
  const Mesh mesh = with_faces(with_vertices(sphere(), sphere().vertices.row(0)), odd);
  const MatchReport report = match_with_sphere(mesh);
  EXPECT_EQ(report.source.topology->degenerate_faces, 3);
  EXPECT_EQ(report.source.topology->duplicate_vertices, 1);
  EXPECT_GT(report.matches, 10);
  EXPECT_THAT(stage_report(report), HasSubstr("3 faces without area"));
}

TEST(OddMeshes, NonManifoldEdgesAreCountedAndHarmless) {
  const Mesh ball = sphere();
  Triangles fins(2, 3);
  fins << ball.triangles(0, 0), ball.triangles(0, 1), 2562, ball.triangles(9, 1), ball.triangles(9, 2), 2562;
  const MatchReport report = match_with_sphere(with_faces(with_vertices(ball, points_of({{0, 0, 3}})), fins));
  EXPECT_EQ(report.source.topology->non_manifold_edges, 2);
  EXPECT_EQ(report.source.topology->non_manifold_vertices, 5);
  EXPECT_GT(report.matches, 10);
  EXPECT_THAT(stage_report(report), HasSubstr("2 non-manifold edges, 5 non-manifold vertices"));
}

TEST(OddMeshes, FacesWoundTheOtherWayAreCounted) {
  Mesh mesh = sphere();
  for (const int face : {3, 700, 2100}) std::swap(mesh.triangles(face, 0), mesh.triangles(face, 1));
  const MatchReport report = match_with_sphere(mesh);
  EXPECT_EQ(report.source.topology->misoriented_faces, 3);
  EXPECT_GT(report.matches, 10);
}

TEST(OddMeshes, SeveralPartsAreCounted) {
  const Mesh ball = sphere();
  const Mesh parts = with_faces(with_vertices(ball, 5 + ball.vertices.array()), ball.triangles.array() + 2562);
  const MatchReport report = match_with_sphere(parts);
  EXPECT_EQ(report.source.topology->components, 2);
  EXPECT_GT(report.matches, match_with_sphere(ball).matches);
  EXPECT_THAT(stage_report(report), HasSubstr("2 components"));
}

TEST(OddMeshes, FarFromTheOriginTheMatchesAreTheSame) {
  Mesh far = sphere();
  far.vertices.array() += 1e7;
  const MatchedPair here = match_pair(sphere(), sphere(), {}), there = match_pair(far, far, {});
  EXPECT_EQ(there.matches.source_keypoints, there.matches.target_keypoints);
  // A coordinate keeps some nine digits behind the point there.
  EXPECT_NEAR(there.report.resolution, here.report.resolution, 1e-8);
  EXPECT_GT(there.matches.size(), 0.95 * here.matches.size());
  EXPECT_GT(match_with_sphere(far).matches, 10);
}

TEST(OddMeshes, AScanWithoutFacesIsMatched) {
  const MatchReport report = match_with_sphere(cloud(sphere()));
  EXPECT_EQ(report.source.topology->components, 0);
  EXPECT_GT(report.matches, 10);
  EXPECT_THAT(stage_report(report), HasSubstr("0 faces, normals towards the origin"));
}

TEST(OddMeshes, OneTriangleHasNothingToMatch) {
  Mesh triangle{points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), Triangles(1, 3)};
  triangle.triangles << 0, 1, 2;
  for (const Mesh& mesh : {triangle, cloud(triangle), Mesh{points_of({{0, 0, 0}, {1, 0, 0}}), Triangles(0, 3)}}) {
    const MatchReport report = match_with_sphere(mesh);
    EXPECT_EQ(report.matches, 0);
    EXPECT_THAT(report.hints, Contains(HasSubstr("no keypoint on the source")));
  }
}

TEST(OddMeshes, NothingButFacesWithoutAreaHasNothingToMatch) {
  Mesh line{Points::Zero(50, 3), Triangles(48, 3)};
  line.vertices.col(0).setLinSpaced(0.0, 1.0);
  for (int face = 0; face < 48; ++face) line.triangles.row(face) << face, face + 1, face + 2;
  const MatchReport report = match_with_sphere(line);
  EXPECT_EQ(report.source.topology->degenerate_faces, 48);
  EXPECT_EQ(report.matches, 0);
  EXPECT_THAT(report.hints, Contains(HasSubstr("no keypoint on the source")));
}

}  // namespace
}  // namespace corral
