// SPDX-License-Identifier: MIT
#include "kernel/surface/mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "kernel/random.h"
#include "tests/support/meshes.h"
#include "tests/support/reference/topology.h"
#include "tests/support/tables.h"

namespace corral {
namespace {

using testing::points_of;

Mesh mesh_of(const Points& vertices, const std::vector<std::array<int, 3>>& faces) {
  Mesh mesh{vertices, Triangles(static_cast<Eigen::Index>(faces.size()), 3)};
  for (std::size_t i = 0; i < faces.size(); ++i)
    mesh.triangles.row(static_cast<Eigen::Index>(i)) << faces[i][0], faces[i][1], faces[i][2];
  return mesh;
}

/// Both meshes in one, the second shifted.
Mesh together(const Mesh& a, const Mesh& b, const Eigen::RowVector3d& offset) {
  Mesh both;
  both.vertices.resize(a.vertices.rows() + b.vertices.rows(), 3);
  both.vertices << a.vertices, b.vertices.rowwise() + offset;
  both.triangles.resize(a.triangles.rows() + b.triangles.rows(), 3);
  both.triangles << a.triangles, b.triangles.array() + static_cast<int>(a.vertices.rows());
  return both;
}

void expect_counts(const Topology& found, const Topology& expected) {
  EXPECT_EQ(found.duplicate_vertices, expected.duplicate_vertices);
  EXPECT_EQ(found.isolated_vertices, expected.isolated_vertices);
  EXPECT_EQ(found.degenerate_faces, expected.degenerate_faces);
  EXPECT_EQ(found.misoriented_faces, expected.misoriented_faces);
  EXPECT_EQ(found.non_manifold_edges, expected.non_manifold_edges);
  EXPECT_EQ(found.non_manifold_vertices, expected.non_manifold_vertices);
  EXPECT_EQ(found.components, expected.components);
  EXPECT_EQ(found.boundary_edges, expected.boundary_edges);
}

/// Of a mesh wound alike without non-manifold edges and vertices.
Topology counts(int duplicate, int isolated, int degenerate, int components, int boundary_edges) {
  return {duplicate, isolated, degenerate, 0, 0, 0, components, boundary_edges};
}

/// Spoils a mesh: turns, repeats and removes faces, joins vertices, and adds faces between any vertices.
void spoil(Mesh& mesh, int changes, RandomStream& random) {
  const auto below = [&](Eigen::Index count) {
    return static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(count)));
  };
  for (; changes > 0; --changes) {
    const Eigen::Index faces = mesh.triangles.rows(), face = below(faces), other = below(faces);
    const auto any_vertex = [&] { return static_cast<int>(below(mesh.vertices.rows())); };
    switch (random.below(6)) {
      case 0:
        std::swap(mesh.triangles(face, 0), mesh.triangles(face, 1));
        break;
      case 1:
        mesh.triangles.row(face) = mesh.triangles.row(other).eval();  // one given twice, one lost
        break;
      case 2:
        mesh.triangles.row(face).swap(mesh.triangles.row(other));
        break;
      case 3:
        mesh.triangles(face, below(3)) = any_vertex();
        break;
      case 4: {
        const int a = any_vertex(), b = any_vertex();  // fans that meet in a vertex
        mesh.triangles = (mesh.triangles.array() == b).select(a, mesh.triangles);
        break;
      }
      default:
        mesh.triangles.conservativeResize(faces + 1, 3);
        mesh.triangles.row(faces) << mesh.triangles(face, 0), mesh.triangles(face, 1), any_vertex();
    }
  }
}

void expect_reference(const Mesh& mesh) {
  expect_counts(inspect_topology(mesh), testing::reference_topology(mesh));
  EXPECT_EQ(vertex_rings(mesh), testing::reference_rings(mesh));
}

TEST(InspectTopology, IsThatOfItsDefinitionHoweverSpoiled) {
  RandomStream random(5);
  int odd = 0, sound = 0;
  for (int round = 0; round < 700 && !HasFailure(); ++round) {
    SCOPED_TRACE(round);
    Mesh mesh = round % 3 == 0
                    ? testing::icosphere(static_cast<int>(random.below(3)))
                    : testing::grid(3 + static_cast<int>(random.below(8)), 3 + static_cast<int>(random.below(8)));
    spoil(mesh, static_cast<int>(random.below(12)), random);
    expect_reference(mesh);
    const Topology found = inspect_topology(mesh);
    odd += found.non_manifold_vertices > 0;
    sound += found.non_manifold_vertices == 0;
  }
  EXPECT_GT(odd, 200);
  EXPECT_GT(sound, 100);
}

TEST(InspectTopology, IsThatOfItsDefinitionForAnyTriangles) {
  RandomStream random(6);
  for (int round = 0; round < 1500 && !HasFailure(); ++round) {
    SCOPED_TRACE(round);
    const auto vertices = 4 + random.below(30), faces = 1 + random.below(3 * vertices);
    Mesh mesh{Points(static_cast<Eigen::Index>(vertices), 3), Triangles(static_cast<Eigen::Index>(faces), 3)};
    for (auto place : mesh.vertices.rowwise()) place = random.direction().transpose();
    for (int& corner : mesh.triangles.reshaped()) corner = static_cast<int>(random.below(vertices));
    expect_reference(mesh);
  }
}

TEST(InspectTopology, ClosedSphere) {
  for (const int level : {0, 1, 3}) {
    const Mesh mesh = testing::icosphere(level);
    expect_counts(inspect_topology(mesh), counts(0, 0, 0, 1, 0));
  }
}

TEST(InspectTopology, Grid) {
  expect_counts(inspect_topology(testing::grid(6, 4, 0.5)), counts(0, 0, 0, 1, 2 * (5 + 3)));
}

TEST(InspectTopology, SeveralParts) {
  expect_counts(inspect_topology(together(testing::icosphere(2), testing::icosphere(1), {5, 0, 0})),
                counts(0, 0, 0, 2, 0));
  const Mesh sheets = together(testing::grid(3, 3), testing::grid(4, 2), {0, 0, 3});
  expect_counts(inspect_topology(together(sheets, testing::icosphere(1), {0, 9, 0})), counts(0, 0, 0, 3, 8 + 8));
}

TEST(InspectTopology, AHoleAddsItsEdges) {
  Mesh mesh = testing::grid(6, 6);
  // The two triangles of the cell in the middle go: four edges more.
  Triangles rest(mesh.triangles.rows() - 2, 3);
  rest << mesh.triangles.topRows(24), mesh.triangles.bottomRows(mesh.triangles.rows() - 26);
  mesh.triangles = rest;
  expect_counts(inspect_topology(mesh), counts(0, 0, 0, 1, 20 + 4));
}

TEST(InspectTopology, OneTriangle) {
  const Topology topology = inspect_topology(mesh_of(points_of({{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}), {{0, 1, 2}}));
  expect_counts(topology, counts(0, 0, 0, 1, 3));
}

TEST(InspectTopology, ThirdTriangleOnAnEdge) {
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}});
  const Topology topology = inspect_topology(mesh_of(vertices, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  EXPECT_EQ(topology.non_manifold_edges, 1);
  EXPECT_EQ(topology.non_manifold_vertices, 2);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.boundary_edges, 6);
}

TEST(InspectTopology, TriangleGivenTwice) {
  // Both run along all three edges the same way; turned, the second closes the first like the back of a leaf.
  const Topology topology =
      inspect_topology(mesh_of(points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), {{0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(topology.misoriented_faces, 1);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.boundary_edges, 0);
}

TEST(InspectTopology, DegenerateTrianglesAreCountedAndLeftOut) {
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {1, 0, 0}, {7, 7, 7}});
  // A good one, one corner twice, all corners one, three on a line, two corners in one place.
  const Mesh mesh = mesh_of(vertices, {{0, 1, 2}, {0, 1, 1}, {2, 2, 2}, {0, 1, 3}, {1, 2, 4}});
  const Topology topology = inspect_topology(mesh);
  EXPECT_EQ(topology.degenerate_faces, 4);
  EXPECT_EQ(topology.duplicate_vertices, 1);
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.boundary_edges, 3);
}

TEST(InspectTopology, IsolatedAndDuplicateVertices) {
  Mesh mesh = testing::icosphere(1);
  const Eigen::Index count = mesh.vertices.rows();
  mesh.vertices.conservativeResize(count + 4, 3);
  mesh.vertices.row(count) = mesh.vertices.row(3);
  mesh.vertices.row(count + 1) << 9, 9, 9;
  mesh.vertices.row(count + 2) << 9, 9, 9;
  mesh.vertices.row(count + 3) << 9, 9, 9;
  expect_counts(inspect_topology(mesh), counts(3, 4, 0, 1, 0));
}

TEST(InspectTopology, WithoutTrianglesNoVertexIsIsolated) {
  const Topology cloud = inspect_topology({points_of({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}), Triangles(0, 3)});
  expect_counts(cloud, counts(1, 0, 0, 0, 0));
  expect_counts(inspect_topology({Points(0, 3), Triangles(0, 3)}), counts(0, 0, 0, 0, 0));
}

TEST(InspectTopology, TwoPartsThatTouchInOneVertex) {
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
  const Topology topology = inspect_topology(mesh_of(vertices, {{0, 1, 2}, {0, 3, 4}}));
  EXPECT_EQ(topology.boundary_edges, 6);
  EXPECT_EQ(topology.non_manifold_edges, 0);
  EXPECT_EQ(topology.non_manifold_vertices, 1);
  EXPECT_EQ(topology.components, 1);
}

TEST(InspectTopology, InconsistentWindingIsTold) {
  // Both run along 0 -> 1.
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
  const Topology pair = inspect_topology(mesh_of(vertices, {{0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(pair.misoriented_faces, 1);
  EXPECT_EQ(pair.non_manifold_vertices, 0);
  EXPECT_EQ(pair.boundary_edges, 4);
}

TEST(InspectTopology, WindingChangesNothingButItsOwnCount) {
  Mesh mesh = testing::icosphere(2);
  const Topology sound = inspect_topology(mesh);
  EXPECT_EQ(sound.misoriented_faces, 0);
  RandomStream random(3);
  int turned = 0;
  for (Eigen::Index face = 0; face < mesh.triangles.rows(); ++face)
    if (random.below(3) == 0) std::swap(mesh.triangles(face, 0), mesh.triangles(face, 1)), ++turned;
  const Topology shuffled = inspect_topology(mesh);
  EXPECT_EQ(shuffled.misoriented_faces, turned);
  EXPECT_EQ(shuffled.non_manifold_vertices, 0);
  EXPECT_EQ(shuffled.boundary_edges, 0);
  EXPECT_EQ(shuffled.components, 1);
}

TEST(InspectTopology, CountsDoNotDependOnPlaceOrVertexOrder) {
  Mesh mesh = together(testing::grid(5, 4), testing::icosphere(1), {0, 0, 4});
  const Topology expected = inspect_topology(mesh);
  Mesh far = mesh;
  far.vertices.array() += 1e7;
  expect_counts(inspect_topology(far), expected);

  Mesh reversed = mesh;
  reversed.vertices = mesh.vertices.colwise().reverse().eval();
  reversed.triangles = (static_cast<int>(mesh.vertices.rows()) - 1 - mesh.triangles.array()).matrix();
  expect_counts(inspect_topology(reversed), expected);
}

TEST(VertexRings, AreTheEdgesOfTheSoundTriangles) {
  // 0 1 2 and 1 0 3 share an edge, 0 4 5 touches them in a vertex; then a third on that edge, two without area, and 6 alone.
  const Points vertices = points_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, 0, 1}});
  const std::vector<Indices> expected = {{1, 2, 3, 4, 5}, {0, 2, 3}, {0, 1}, {0, 1}, {0, 5}, {0, 4}, {}};
  EXPECT_EQ(vertex_rings(mesh_of(vertices, {{0, 1, 2}, {1, 0, 3}, {0, 4, 5}, {0, 1, 6}, {3, 2, 0}, {6, 6, 1}})),
            expected);
  EXPECT_EQ(vertex_rings(mesh_of(vertices, {{0, 1, 2}, {0, 1, 3}, {0, 5, 4}})), expected) << "winding";
}

TEST(VertexRings, OfAClosedSphere) {
  int five = 0, six = 0;
  for (const Indices& ring : vertex_rings(testing::icosphere(3))) {
    five += ring.size() == 5;
    six += ring.size() == 6;
    EXPECT_TRUE(std::is_sorted(ring.begin(), ring.end()));
  }
  EXPECT_EQ(five, 12);
  EXPECT_EQ(six, 630);
  EXPECT_TRUE(vertex_rings({Points(0, 3), Triangles(0, 3)}).empty());
}

TEST(DistinctPoints, SortsAndDropsCopies) {
  const Points points = points_of({{2, 0, 0}, {1, 5, 0}, {1, 4, 9}, {2, 0, 0}, {1, 4, 8}, {1, 5, 0}});
  EXPECT_EQ(distinct_points(points), points_of({{1, 4, 8}, {1, 4, 9}, {1, 5, 0}, {2, 0, 0}}));
  EXPECT_EQ(distinct_points(Points(0, 3)).rows(), 0);
  EXPECT_EQ(distinct_points(Points::Ones(9, 3)).rows(), 1);
  EXPECT_EQ(distinct_points(points_of({{0.0, 1, 1}, {-0.0, 1, 1}})).rows(), 1);
  EXPECT_EQ(distinct_points(points_of({{1, 1, 1}, {1 + 1e-15, 1, 1}})).rows(), 2);
}

TEST(VertexRings, AreTheSameFromManyThreadsAtOnce) {
  const Mesh mesh = testing::bumpy_sphere(3, 1);
  const auto expected = vertex_rings(mesh);
  std::vector<std::vector<Indices>> found(8);
  std::vector<std::thread> threads;
  for (auto& rings : found)
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) rings = vertex_rings(mesh);
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& rings : found) EXPECT_EQ(rings, expected);
}

}  // namespace
}  // namespace corral
