// SPDX-License-Identifier: MIT
// corral dataset make: data sets from any meshes. A maker is a function make_x(options, progress) and a function here.
#include "apps/commands/command_files.h"
#include "apps/commands/command_options.h"
#include "apps/dataset/make_b3r.h"
#include "apps/dataset/make_challenge.h"
#include "apps/dataset/make_default.h"
#include "apps/dataset/make_tables.h"
#include "apps/dataset/make_u3m.h"
#include "apps/dataset/make_u3or.h"
#include "apps/dataset/set_folder.h"
#include "apps/runtime/output.h"
#include "apps/runtime/workers.h"

namespace corral {
namespace {

void add_output(CLI::App& command, std::string& output) {
  command.add_option("-o,--output", output, "Folder of the new set")->type_name("FOLDER")->required();
}

void add_seed(CLI::App& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "Random seed")->capture_default_str();
}

void add_models(CLI::App& command, std::string& models) {
  command.add_option("--models", models, "Folder of models; every mesh in it is used")->type_name("FOLDER")->required();
}

void add_noise(CLI::App& command, double& noise_pr) {
  command.add_option("--noise-pr", noise_pr, "Deviation of normal noise along each ray of the scanner")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
}

/// The options of a maker, and what they are filled from.
template <class Options>
struct MakeSettings {
  std::string models;
  Options options;
  int threads = 0;

  void resolve() {
    keep_inputs({models}, {options.output + "/models", options.output + "/scenes", options.output + "/views"});
    options.models = mesh_files(models);
    options.parallel = workers(threads);
  }
};

void add_b3r(CLI::App& make, Action& action) {
  auto* command = make.add_subcommand("b3r", "Retrieval: moved copies of models at 9 levels of noise and 9 of density");
  auto settings = std::make_shared<MakeSettings<MakeB3rOptions>>();
  add_models(*command, settings->models);
  add_output(*command, settings->options.output);
  add_seed(*command, settings->options.seed);
  command->add_option("--scenes-per-model", settings->options.scenes_per_model, "Moved copies of each model")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_threads(*command, settings->threads);
  command->footer(
      "Noise of 0.05 .. 0.45 pr, densities of 0.9 .. 0.1. An interrupted command continues when it is repeated.\n"
      "Example:\n  corral dataset make b3r --models meshes -o data/b3r --scenes-per-model 2");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->resolve();
      const MakeB3rOptions& options = settings->options;
      Progress progress(static_cast<double>(options.models.size()) * options.scenes_per_model);
      make_b3r(options, progress);
      return kOk;
    };
  });
}

void add_u3or(CLI::App& make, Action& action) {
  auto* command = make.add_subcommand("u3or", "Recognition: heaps of models seen by a virtual range scanner");
  auto settings = std::make_shared<MakeSettings<MakeU3orOptions>>();
  add_models(*command, settings->models);
  add_output(*command, settings->options.output);
  add_seed(*command, settings->options.seed);
  command->add_option("--scenes", settings->options.scenes, "How many heaps")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_noise(*command, settings->options.noise_pr);
  add_threads(*command, settings->threads);
  command->footer(
      "Scenes of 4 and 5 models in turn, chosen so that occlusion spreads over 60 .. 95 % and clutter over 65 .. 95 %;\n"
      "their distribution is printed at the end. An interrupted command continues when it is repeated.\n"
      "Example:\n"
      "  corral dataset make u3or --models meshes -o data/u3or --scenes 12");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->resolve();
      VisibilityCounts counts;
      {
        Progress progress(3.0 * settings->options.scenes);
        counts = make_u3or(settings->options, progress);
      }
      say(to_text(counts));
      return kOk;
    };
  });
}

void add_u3m(CLI::App& make, Action& action) {
  auto* command = make.add_subcommand("u3m", "Registration: models seen from all around by a virtual range scanner");
  auto settings = std::make_shared<MakeSettings<MakeU3mOptions>>();
  add_models(*command, settings->models);
  add_output(*command, settings->options.output);
  add_seed(*command, settings->options.seed);
  command->add_option("--views", settings->options.views, "Views of each model")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_noise(*command, settings->options.noise_pr);
  add_threads(*command, settings->threads);
  command->footer(
      "Pairs of views that overlap by 30 to 90 % are kept; their truth is exact. An interrupted command continues when\n"
      "it is repeated.\n"
      "Example:\n"
      "  corral dataset make u3m --models meshes -o data/u3m --views 8");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->resolve();
      Progress progress(static_cast<double>(settings->options.models.size()));
      make_u3m(settings->options, progress);
      return kOk;
    };
  });
}

void add_default(CLI::App& make, Action& action) {
  struct Settings {
    MakeDefaultOptions options;
    int threads = 0;
  };
  auto* command = make.add_subcommand("default", "All sets of the study from meshes in Debian packages");
  auto settings = std::make_shared<Settings>();
  command->add_option("--meshes", settings->options.meshes, "Folder of libcgal-demo's meshes")
      ->type_name("FOLDER")
      ->required();
  command->add_option("--scenes", settings->options.scenes, "Folder of opencv-doc's scenes; without it no real scenes")
      ->type_name("FOLDER");
  add_output(*command, settings->options.output);
  add_seed(*command, settings->options.seed);
  add_threads(*command, settings->threads);
  command->footer(
      "'corral dataset list' lists the files that it uses. An interrupted command continues when it is repeated.\n"
      "Example:\n  corral dataset make default --meshes build/data/meshes --scenes build/data/scenes -o "
      "build/data/default");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->options.parallel = workers(settings->threads);
      Progress progress(default_steps(settings->options));
      make_default(settings->options, progress);
      return kOk;
    };
  });
}

void add_challenge(CLI::App& make, Action& action) {
  struct Settings {
    MakeChallengeOptions options;
    int threads = 0;
  };
  auto* command = make.add_subcommand("challenge", "Tables of any size and share of correct matches, out of real ones");
  auto settings = std::make_shared<Settings>();
  MakeChallengeOptions& options = settings->options;
  command->add_option("--tables", options.tables, "A data set whose pairs have tables of matches and truths")
      ->type_name("FOLDER")
      ->required();
  add_output(*command, options.output);
  command->add_option("--sizes", options.sizes, "Matches in a table: numbers between commas")
      ->delimiter(',')
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--ratios", options.inlier_ratios, "Correct ones among them, in percent")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--noise-pr", options.noises_pr, "Deviation of normal noise on the target points")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--repeats", options.repeats, "Tables of each kind out of each real one")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--threshold-pr", options.threshold_pr, "Residual up to which a match is correct")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  add_seed(*command, options.seed);
  add_threads(*command, settings->threads);
  command->footer(
      "Real rows are kept or dropped. Where more incorrect ones are needed, the source side of one is paired with the\n"
      "target side of another; where more correct ones are, matches beside real ones are made, with their residuals.\n"
      "An interrupted command continues when it is repeated. The experiments inlier-ratio and size use such a set.\n"
      "Example:\n  corral dataset make challenge --tables data/field --sizes 1000,10000 --ratios 1,5,20 -o "
      "data/challenge");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      const MakeChallengeOptions& chosen = settings->options;
      keep_inputs({chosen.tables}, {chosen.output});
      settings->options.parallel = workers(settings->threads);
      Progress progress(count_challenge(chosen));
      make_challenge(chosen, progress);
      return kOk;
    };
  });
}

void add_table_set(CLI::App& make, Action& action) {
  struct Settings {
    MakeTablesOptions options;
    std::vector<std::string> set;
    int threads = 0;
  };
  auto* command =
      make.add_subcommand("tables", "Tables of matches from a set of surfaces, for scoreboards and challenges");
  auto settings = std::make_shared<Settings>();
  command->add_option("--data", settings->options.data, "A data set with surfaces")->type_name("FOLDER")->required();
  add_output(*command, settings->options.output);
  add_detector_and_descriptor(*command, settings->options.matching);
  add_set_option(*command, settings->set);
  add_threads(*command, settings->threads);
  command->footer(
      "Truths and attributes are kept. An interrupted command continues when it is repeated.\n"
      "Example:\n  corral dataset make tables --data build/data/default/u3m -o data/u3m-tables");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      MakeTablesOptions& options = settings->options;
      const OptionsByName given = parse_set(settings->set);
      require_in_use(given, options.matching.in_use());
      options.matching.options = surface_part(given);
      check_usage(options.matching);
      keep_inputs({options.data}, {options.output});
      options.parallel = workers(settings->threads);
      Progress progress(count_tables(options));
      make_tables(options, progress);
      return kOk;
    };
  });
}

}  // namespace

void add_dataset_make(CLI::App& dataset, Action& action) {
  auto* make = dataset.add_subcommand("make", "A new set from meshes or tables, with exact truth");
  make->require_subcommand(1);
  add_b3r(*make, action);
  add_u3or(*make, action);
  add_u3m(*make, action);
  add_table_set(*make, action);
  add_challenge(*make, action);
  add_default(*make, action);
}

}  // namespace corral
