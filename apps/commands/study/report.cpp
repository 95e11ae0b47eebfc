// SPDX-License-Identifier: MIT
// corral report: the figures, tables and pictures of studies.
#include "apps/runtime/output.h"

#include <filesystem>
#include <map>

#include "apps/claims/claim_report.h"
#include "apps/commands/commands.h"
#include "apps/report/figure/folders.h"
#include "apps/report/figure/gnuplot.h"
#include "apps/report/figure/rank_diagram.h"
#include "apps/report/page.h"
#include "apps/report/pair_gallery.h"
#include "apps/report/study_figures.h"
#include "apps/results/comparison.h"
#include "apps/results/losses.h"
#include "apps/runtime/progress.h"
#include "apps/runtime/workers.h"
#include "io/disk/file.h"
#include "kernel/error.h"

namespace corral {
namespace {

struct Settings {
  std::vector<std::string> runs, pairs;
  std::string output;
  int pairs_in_3d = PageOptions().pairs_in_3d;
};

/// For every experiment with two or more groupers on common pairs, their average ranks by F1 and by success.
std::vector<RankDiagram> rank_diagrams(const std::vector<StudyResults>& studies) {
  std::vector<RankDiagram> diagrams;
  for (const StudyResults& study : studies)
    for (const ExperimentTable& table : study.tables)
      for (const Measure* measure : {&corral::measure("f1"), &corral::measure("success_5pr")}) {
        const MethodRanks compared = rank_methods(table, *measure);
        if (compared.methods.size() < 2 || compared.pairs < 2) continue;
        const ExperimentInfo& info = table.info;
        diagrams.push_back({file_name_part(info.name) + "-" + file_name_part(info.dataset) + "-ranks-" + measure->title,
                            info.title + ": average ranks by " + measure->title, compared.methods,
                            compared.ranks.average_ranks, compared.ranks.critical_difference, compared.ranks.cliques,
                            info.titles});
      }
  return diagrams;
}

/// Writes data, tables and scripts. Returns the names of the scripts.
std::vector<std::string> write_figures(const StudyFigures& figures, const std::vector<RankDiagram>& ranks,
                                       const std::string& folder) {
  std::vector<FileContent> files;
  std::vector<std::string> names;
  const auto add_data = [&](const std::string& name, const std::string& csv) {
    files.push_back({folder + kData + name + ".csv", csv});
  };
  const auto add_script = [&](const std::string& name, const std::string& script) {
    files.push_back({folder + kScripts + name + ".gp", script});
    names.push_back(name);
  };
  for (const PanelFigure& figure : figures.panels) {
    for (const Panel& panel : figure.panels) {
      add_data(panel.name, panel_csv(panel));
      files.push_back({folder + kTables + panel.name + ".tex", panel_latex(panel)});
    }
    add_script(figure.name, panel_script(figure));
  }
  for (const BoxPanel& panel : figures.boxes) {
    add_data(panel.name, box_csv(panel));
    add_script(panel.name, box_script(panel));
  }
  for (const RankDiagram& diagram : ranks) {
    add_data(diagram.name, rank_csv(diagram));
    add_script(diagram.name, rank_script(diagram));
  }
  write_files(files);
  return names;
}

/// For every experiment, where its pairs were lost.
void write_losses(const std::vector<StudyFolder>& runs, const std::string& folder) {
  std::map<std::string, std::vector<LossRow>> losses;
  for (const StudyFolder& run : runs)
    for (const LossRow& row : losses_of(run))
      if (row.pairs > 0)  // those of a study of times judge no pose
        losses[file_name_part(row.experiment) + "-" + file_name_part(row.dataset)].push_back(row);
  std::vector<FileContent> files;
  for (const auto& [name, rows] : losses) files.push_back({folder + kData + name + "-losses.csv", losses_text(rows)});
  write_files(files);
}

/// Returns false and prints the reason if one of the pairs cannot be drawn.
bool write_pictures(const GalleryPair& pair, const std::string& folder) {
  try {
    std::vector<FileContent> pictures = draw_gallery_pair(pair);
    for (FileContent& picture : pictures) picture.path = folder + picture.path;
    write_files(pictures);
    return true;
  } catch (const IoError& error) {
    say("corral report: no pictures of " + pair.name() + ": " + error.what());
    return false;
  }
}

/// Writes the findings, and everything on one page.
void write_page(const std::vector<StudyFolder>& runs, const std::vector<StudyResults>& studies,
                const Settings& settings) {
  const ClaimBook book = built_in_claims();
  PageOptions options;
  options.pairs_in_3d = settings.pairs_in_3d;
  options.verdicts = judge_claims(book, studies, workers(0));
  const std::string folder = settings.output + "/";
  write_file(folder + "claims.txt", claims_text(*options.verdicts, book.slips));
  write_file(folder + "index.html", report_page(runs, studies, options));
}

int report(const Settings& settings) {
  const std::vector<StudyFolder> runs = read_runs(settings.runs);
  const std::vector<StudyResults> studies = results_of(runs, workers(0));
  const StudyFigures figures = study_figures(studies);
  const std::vector<GalleryPair> gallery = choose_gallery(runs, settings.pairs);
  const std::string folder = settings.output + "/", pictures = folder + kPictures;
  for (const char* part : {kFigures, kScripts, kData, kTables}) make_folder(folder + part);
  if (!gallery.empty()) make_folder(pictures);
  const std::vector<std::string> names = write_figures(figures, rank_diagrams(studies), folder);
  write_losses(runs, folder);
  Progress progress(40 + static_cast<double>(names.size()) + 40.0 * static_cast<double>(gallery.size()));
  progress.begin("page", 40);
  write_page(runs, studies, settings);
  bool is_whole = true;
  for (const GalleryPair& pair : gallery) {
    progress.begin("pictures of " + pair.name(), 40);
    is_whole = write_pictures(pair, pictures) && is_whole;
  }
  for (const std::string& name : names) {
    progress.begin(name);
    run_gnuplot(settings.output, name);
  }
  say("the report is " + folder + "index.html");
  return is_whole ? kOk : kPartial;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("report", "Figures, tables, pictures and a page of the results of 'corral evaluate'");
  auto settings = std::make_shared<Settings>();
  command->add_option("studies", settings->runs, "Folders of 'corral evaluate'")->type_name("STUDY")->required();
  command->add_option("-o,--output", settings->output, "Folder for the report")->type_name("FOLDER")->required();
  command
      ->add_option(
          "--pairs", settings->pairs,
          "Pairs to draw, 'pair' or 'dataset/pair', separated by commas (default: the pair of each data set with the "
          "median share of correct matches)")
      ->type_name("NAMES")
      ->delimiter(',');
  command
      ->add_option("--pairs-in-3d", settings->pairs_in_3d,
                   "Most pairs whose surfaces and matches are on the page, as far as they fit into its 20 MB")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->footer(
      "index.html is the whole report on one page that opens from disk; claims.txt says which findings hold.\n"
      "Every figure is figures/<experiment>-<dataset>-<name>.pdf and .svg, drawn by scripts/<same>.gp: edit it and "
      "run\n"
      "gnuplot on it in that folder. Numbers are in data/ (.csv), tables in tables/ (.tex), pictures of pairs in "
      "pairs/.\n"
      "Examples:\n  corral report runs/all -o report\n"
      "  corral report runs/b3r runs/time --pairs b3r/bunny-0.25 -o report");
  command->callback([settings, &action] { action = [settings] { return report(*settings); }; });
}

}  // namespace corral
