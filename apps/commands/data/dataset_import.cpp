// SPDX-License-Identifier: MIT
// corral dataset import: published folders as data sets. An importer is a function import_x(options, progress) that returns
// notes for the user, and a function here.
#include "apps/commands/command_options.h"
#include "apps/dataset/import_b3r.h"
#include "apps/dataset/import_u3m.h"
#include "apps/dataset/import_u3or.h"
#include "apps/runtime/output.h"
#include "apps/runtime/workers.h"

namespace corral {
namespace {

/// The options that all importers have.
void add_folders(CLI::App& command, std::string& folder, std::string& output) {
  command.add_option("folder", folder, "Folder of the published files")->type_name("FOLDER")->required();
  command.add_option("-o,--output", output, "Folder of the new set; the meshes stay where they are")
      ->type_name("FOLDER")
      ->required();
}

void say_all(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say("note: " + note);
}

void add_b3r(CLI::App& import, Action& action) {
  struct Settings {
    ImportB3rOptions options;
    std::string levels = "study";
    int threads = 0;
  };
  auto* command = import.add_subcommand("b3r", "The Bologna retrieval set");
  auto settings = std::make_shared<Settings>();
  add_folders(*command, settings->options.folder, settings->options.output);
  command
      ->add_option(
          "--levels", settings->levels,
          "study: 9 levels of noise and 9 of density, made from models and truths; stored: the published noisy scenes")
      ->check(CLI::IsMember({"study", "stored"}))
      ->capture_default_str();
  command->add_option("--seed", settings->options.seed, "Seed of noise and density")->capture_default_str();
  add_threads(*command, settings->threads);
  command->footer(
      "'corral dataset list' shows the layout; missing parts are reported and left out. An interrupted command "
      "continues\n"
      "when it is repeated.\n"
      "Example:\n  corral dataset import b3r ~/b3r -o data/b3r");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->options.stored = settings->levels == "stored";
      settings->options.parallel = workers(settings->threads);
      std::vector<std::string> notes;
      {
        Progress progress(kB3rScenes);
        notes = import_b3r(settings->options, progress);
      }
      say_all(notes);
      return kOk;
    };
  });
}

void add_u3or(CLI::App& import, Action& action) {
  struct Settings {
    ImportU3orOptions options;
    int threads = 0;
  };
  auto* command = import.add_subcommand("u3or", "The UWA object recognition set");
  auto settings = std::make_shared<Settings>();
  add_folders(*command, settings->options.folder, settings->options.output);
  add_threads(*command, settings->threads);
  command->footer(
      "'corral dataset list' shows the layout; missing parts are reported and left out.\n"
      "Example:\n  corral dataset import u3or ~/u3or -o data/u3or");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      settings->options.parallel = workers(settings->threads);
      std::vector<std::string> notes;
      {
        Progress progress(kU3orPairs);
        notes = import_u3or(settings->options, progress);
      }
      say_all(notes);
      return kOk;
    };
  });
}

void add_u3m(CLI::App& import, Action& action) {
  struct Settings {
    ImportU3mOptions options;
    SensorSettings sensor;
    int threads = 0;
  };
  auto* command =
      import.add_subcommand("u3m", "The UWA views, or any views of objects, with a truth computed by aligning them");
  auto settings = std::make_shared<Settings>();
  add_folders(*command, settings->options.folder, settings->options.output);
  command
      ->add_option("--truth", settings->options.truth,
                   "Use published transforms instead: VIEW-to-ANYTHING.xf into one frame, or VIEW-to-VIEW.xf")
      ->type_name("FOLDER");
  command
      ->add_option("--object", settings->options.object,
                   "The object that all views show (default: their names without numbers)")
      ->type_name("NAME");
  add_sensor_options(*command, settings->sensor);
  add_threads(*command, settings->threads);
  command->footer(
      "Views are meshes, or lists of points seen by a sensor. Pairs that overlap by 30 to 90 % are kept; doubtful "
      "ones\n"
      "are reported.\n"
      "Examples:\n  corral dataset import u3m ~/u3m -o data/u3m\n"
      "  corral dataset import u3m ~/u3m/views -o data/u3m --truth ~/u3m/gt");
  command->callback([settings, &action] {
    action = [settings]() -> int {
      if (settings->sensor.are_given()) settings->options.sensor = view_options(settings->sensor);
      settings->options.parallel = workers(settings->threads);
      std::vector<std::string> notes;
      {
        Progress progress(import_steps(settings->options));
        notes = import_u3m(settings->options, progress);
      }
      say_all(notes);
      return kOk;
    };
  });
}

}  // namespace

void add_dataset_import(CLI::App& dataset, Action& action) {
  auto* import = dataset.add_subcommand("import", "A published set from its downloaded folder");
  import->require_subcommand(1);
  add_b3r(*import, action);
  add_u3or(*import, action);
  add_u3m(*import, action);
}

}  // namespace corral
