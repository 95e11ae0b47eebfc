// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/commands.h"
#include "apps/pair/external_method.h"
#include "apps/pair/match_settings.h"
#include "grouping/registry.h"
#include "kernel/rigid_transform.h"
#include "kernel/surface/scan/view_triangulation.h"

// Options that several subcommands have. Whatever is wrong with them is a UsageError.
namespace corral {

/// All that decides how two surfaces are matched, but --set.
void add_match_options(CLI::App& command, MatchSettings& settings);
void add_detector_and_descriptor(CLI::App& command, MatchSettings& settings);  ///< of these, the two alone
void check_usage(const MatchSettings& settings);

/// --drop-stray, for read_input().
void add_drop_stray(CLI::App& command, bool& drop_stray);

/// --set NAME.OPTION=VALUE, as typed.
void add_set_option(CLI::App& command, std::vector<std::string>& set);

/// --set, by the name of a grouper, detector or descriptor.
OptionsByName parse_set(const std::vector<std::string>& set);

/// Refuses options of a name that is not among those in use.
void require_in_use(const OptionsByName& options, const std::vector<std::string>& in_use);

/// Those of the options that belong to a detector or a descriptor.
OptionsByName surface_part(const OptionsByName& options);

/// A grouper with its part of the options.
ConfiguredGrouper configure_grouper(const std::string& name, const OptionsByName& options);

void check_threshold(double threshold_pr);

/// A pose of a file, FILE or FILE:KEY; what was done to read it is said on stderr.
RigidTransform read_pose(const std::string& name);

/// --truth and --truth-inverse.
struct TruthSettings {
  std::string file;
  bool is_inverse = false;
  bool empty() const { return file.empty(); }
};
/// `purpose` follows what a truth is; returns the option --truth.
CLI::Option* add_truth_options(CLI::App& command, TruthSettings& settings, const std::string& purpose = "");
RigidTransform read_truth(const TruthSettings& settings);

/// The text of an option as a point or direction "x,y,z".
Eigen::Vector3d parse_vector(const std::string& option, const std::string& text);

/// --threads, checked here, for workers().
void add_threads(CLI::App& command, int& threads);

/// --sensor and --direction, as typed.
struct SensorSettings {
  std::optional<std::string> sensor, direction;  ///< one of them at most

  bool are_given() const { return sensor || direction; }
};
void add_sensor_options(CLI::App& command, SensorSettings& settings);
ViewOptions view_options(const SensorSettings& settings);

/// --plugin, --external and --external-timeout, as typed.
struct ExternalSettings {
  std::vector<std::string> plugins, methods;
  double timeout_s = 60;

  bool empty() const { return plugins.empty() && methods.empty(); }
};
void add_plugin_option(CLI::App& command, std::vector<std::string>& plugins);
void add_external_options(CLI::App& command, ExternalSettings& settings);
/// Adds those of plug-ins to methods(). Throws as load_plugin.
void load_plugins(const std::vector<std::string>& files);
/// These names, then those of plug-ins that are not among them.
std::vector<std::string> with_plugins(std::vector<std::string> names);
/// Each of them once, with half of the machine's memory.
std::vector<ExternalMethod> external_methods(const ExternalSettings& settings);
/// The words that give these options again.
std::vector<std::string> words_of(const ExternalSettings& settings);

/// A number of bytes: "1000", "500MB", "1.5GB", "2GiB"; in any case of letters. Absent if it is none.
std::optional<std::uint64_t> parse_size(const std::string& text);
/// An option whose value is one.
CLI::Option* add_size(CLI::App& command, const std::string& option, std::uint64_t& bytes, const std::string& purpose);

/// --memory-limit, in bytes; half of the machine unless it is given.
void add_memory_limit(CLI::App& command, std::uint64_t& bytes);

/// --rows and --select: what is done with the poses of groupers beside the refinement of each selection (kRows, kSelect).
void add_pose_options(CLI::App& command, std::string& rows, std::string& select);

}  // namespace corral
