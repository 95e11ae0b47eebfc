// SPDX-License-Identifier: MIT
// corral perturb: a moved and noisy copy of a mesh, and the motion that made it.
#include <cmath>

#include "apps/commands/command_files.h"
#include "apps/commands/commands.h"
#include "apps/runtime/output.h"
#include "io/disk/file.h"
#include "io/mesh/mesh_file.h"
#include "io/pose/transform_file.h"
#include "kernel/random.h"
#include "kernel/surface/mesh/perturbation.h"
#include "kernel/surface/search/resolution.h"

namespace corral {
namespace {

struct Settings {
  std::string mesh, output, truth;
  double noise_pr = 0;
  std::uint64_t seed = 1;
  bool json = false;
};

int perturb(const Settings& settings) {
  if (!(settings.noise_pr >= 0) || !std::isfinite(settings.noise_pr))
    throw UsageError("--noise-pr: expected a length of at least 0");
  check_ply_name(settings.output);
  keep_inputs({settings.mesh}, {settings.output, settings.truth});
  const Mesh mesh = read_input(settings.mesh);
  const RigidTransform motion = random_motion(mesh, derive_seed(settings.seed, "motion"));
  const double deviation = settings.noise_pr > 0 ? settings.noise_pr * point_resolution(mesh.vertices) : 0;
  const Mesh copy = add_gaussian_noise(move_mesh(mesh, motion), deviation, derive_seed(settings.seed, "noise"));
  std::vector<FileContent> files{{settings.output, ply_text(copy)}};
  if (!settings.truth.empty()) files.push_back({settings.truth, transform_text(motion)});
  write_files(files);
  if (settings.json)
    put("", Json{{"seed", settings.seed},
                 {"noise_pr", settings.noise_pr},
                 {"deviation", deviation},
                 {"copy_from_mesh", to_json(motion)}});
  return kOk;
}

}  // namespace

void add_perturb(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("perturb", "A moved and noisy copy of a mesh, with the motion that made it");
  auto settings = std::make_shared<Settings>();
  command->add_option("mesh", settings->mesh, "Mesh or point cloud")->type_name("FILE")->required();
  command->add_option("-o,--output", settings->output, "The copy (PLY)")->type_name("FILE")->required();
  command->add_option("--truth", settings->truth, "Where the motion goes: copy_from_mesh, a 4x4 matrix")
      ->type_name("FILE");
  command->add_option("--noise-pr", settings->noise_pr, "Standard deviation of Gaussian noise on every coordinate")
      ->capture_default_str();
  command->add_option("--seed", settings->seed, "Seed of motion and noise")->capture_default_str();
  command->add_flag("--json", settings->json, "Motion and deviation as JSON on standard output");
  command->footer(
      "Example:\n  corral perturb bunny.off --noise-pr 0.25 -o copy.ply --truth truth.txt\n"
      "  corral run bunny.off copy.ply --truth truth.txt --resolution source");
  command->callback([settings, &action] { action = [settings] { return perturb(*settings); }; });
}

}  // namespace corral
