// SPDX-License-Identifier: MIT
#include "apps/commands/manual.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>

#include "apps/commands/commands.h"
#include "apps/runtime/build_info.h"
#include "io/disk/file.h"

namespace corral {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_name().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

std::vector<const CLI::Option*> operands_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

/// "corral dataset make" with something between the words.
std::string path_of(const CLI::App& app, const std::string& separator) {
  const CLI::App* parent = app.get_parent();
  return parent ? path_of(*parent, separator) + separator + app.get_name() : app.get_name();
}

/// Its spellings: "-o", "--output".
std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// What it takes, without what checks add to it (":{a,b}"); empty for a flag.
std::string value_of(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0) return "";
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(":{"));
}

/// The words that an option accepts, where its type lists them: "auto|file|mesh".
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = value_of(option);
  std::vector<std::string> words;
  if (type.find('|') == std::string::npos) return words;
  std::istringstream stream(type);
  for (std::string word; std::getline(stream, word, '|');)
    if (!word.empty() &&
        std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '-'; }) &&
        std::islower(static_cast<unsigned char>(word[0])))
      words.push_back(word);
  return words;
}

bool takes_file(const CLI::Option& option) {
  const std::string type = value_of(option);
  return type.find("FILE") != std::string::npos || type.find("FOLDER") != std::string::npos;
}

/// Text that roff prints as it is.
std::string roff(const std::string& text) {
  std::string escaped;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else
      escaped += c;
    at_start = c == '\n';
  }
  return escaped;
}

/// Text before the examples, and these.
std::pair<std::string, std::string> split_footer(const std::string& footer) {
  for (const char* word : {"Examples:\n", "Example:\n"}) {
    const std::size_t at = footer.find(word);
    if (at != std::string::npos) return {footer.substr(0, at), footer.substr(at + std::string(word).size())};
  }
  return {footer, ""};
}

std::string synopsis(const CLI::App& app) {
  std::string text = ".B " + roff(path_of(app, " ")) + "\n";
  if (!options_of(app).empty()) text += "[OPTIONS]\n";
  for (const CLI::Option* operand : operands_of(app)) {
    const std::string name = operand->get_single_name() + (operand->get_items_expected_max() > 1 ? "..." : "");
    text += (operand->get_required() ? name : "[" + name + "]") + "\n";
  }
  if (!commands_of(app).empty()) text += "COMMAND\n";
  return text;
}

std::string entry(const std::string& bold, const std::string& value, const CLI::Option& option) {
  std::string text = ".TP\n\\fB" + roff(bold) + "\\fR" + (value.empty() ? "" : " \\fI" + roff(value) + "\\fR") + "\n";
  text += roff(option.get_description());
  if (!option.get_default_str().empty()) text += " (default: " + roff(option.get_default_str()) + ")";
  return text + "\n";
}

std::string page_of(const CLI::App& app, const std::string& version) {
  std::string title = path_of(app, "-");
  std::transform(title.begin(), title.end(), title.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto [text, examples] = split_footer(app.get_footer());
  std::string page = ".TH \"" + title + "\" 1 \"\" \"corral " + version + "\" \"Corral\"\n.ad l\n.SH NAME\n" +
                     roff(path_of(app, "-")) + " \\- " + roff(app.get_description()) + "\n.SH SYNOPSIS\n" +
                     synopsis(app);
  if (!text.empty()) page += ".SH DESCRIPTION\n" + roff(text) + "\n";
  if (!operands_of(app).empty()) {
    page += ".SH ARGUMENTS\n";
    for (const CLI::Option* operand : operands_of(app))
      page += entry(operand->get_single_name(), value_of(*operand), *operand);
  }
  if (!options_of(app).empty()) {
    page += ".SH OPTIONS\n";
    for (const CLI::Option* option : options_of(app)) {
      std::string names;
      for (const std::string& name : spellings(*option)) names += (names.empty() ? "" : ", ") + name;
      page += entry(names, value_of(*option), *option);
    }
  }
  if (!commands_of(app).empty()) {
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app))
      page += ".TP\n.BR " + roff(path_of(*command, "-")) + " (1)\n" + roff(command->get_description()) + "\n";
  }
  if (!examples.empty()) page += ".SH EXAMPLES\n.nf\n" + roff(examples) + "\n.fi\n";
  if (app.get_parent()) page += ".SH SEE ALSO\n.BR " + roff(path_of(*app.get_parent(), "-")) + " (1)\n";
  return page;
}

/// All commands, those with subcommands before these.
std::vector<const CLI::App*> all_apps(const CLI::App& app) {
  std::vector<const CLI::App*> apps = {&app};
  for (const CLI::App* command : commands_of(app))
    for (const CLI::App* each : all_apps(*command)) apps.push_back(each);
  return apps;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// What may follow the words of a command: its subcommands and options.
std::string words_after(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::App* command : commands_of(app)) words.push_back(command->get_name());
  for (const CLI::Option* option : options_of(app))
    for (const std::string& name : spellings(*option)) words.push_back(name);
  return joined(words);
}

std::string bash_completion(const CLI::App& app) {
  std::string values, words;
  for (const CLI::App* each : all_apps(app)) {
    const std::string path = path_of(*each, " ");
    words += "    '" + path + "') words='" + words_after(*each) + "' ;;\n";
    for (const CLI::Option* option : options_of(*each)) {
      const std::vector<std::string> choices = choices_of(*option);
      if (choices.empty()) continue;
      for (const std::string& name : spellings(*option))
        values += "    '" + path + " " + name + "') COMPREPLY=($(compgen -W '" + joined(choices) +
                  "' -- \"$now\")); return ;;\n";
    }
  }
  return "# bash completion of corral\n"
         "_corral() {\n"
         "  local now=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} path=corral words='' word\n"
         "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
         "    case \" $(_corral_commands \"$path\") \" in *\" $word \"*) path=\"$path $word\" ;; esac\n"
         "  done\n"
         "  case \"$path $before\" in\n" +
         values +
         "  esac\n"
         "  case $path in\n" +
         words +
         "  esac\n"
         "  case $now in\n"
         "    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$now\")) ;;\n"
         "    *) COMPREPLY=($(compgen -W \"$(_corral_commands \"$path\")\" -- \"$now\") $(compgen -f -- \"$now\")) ;;\n"
         "  esac\n"
         "}\n" +
         [&] {
           std::string text = "_corral_commands() {\n  case $1 in\n";
           for (const CLI::App* each : all_apps(app)) {
             std::vector<std::string> names;
             for (const CLI::App* command : commands_of(*each)) names.push_back(command->get_name());
             if (!names.empty()) text += "    '" + path_of(*each, " ") + "') echo '" + joined(names) + "' ;;\n";
           }
           return text + "  esac\n}\n";
         }() +
         "complete -o filenames -F _corral corral\n";
}

/// The first line, without what a shell would read as syntax.
std::string plain(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  for (char& c : line)
    if (std::string("'\"\\`$[]:").find(c) != std::string::npos) c = ' ';
  return line;
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion of corral\n";
  for (const CLI::App* each : all_apps(app)) {
    std::string condition = "__fish_use_subcommand";
    std::string seen;
    for (const CLI::App* at = each; at->get_parent(); at = at->get_parent())
      seen = "__fish_seen_subcommand_from " + at->get_name() + (seen.empty() ? "" : "; and " + seen);
    if (!seen.empty()) condition = seen;
    const std::string start = "complete -c corral -n '" + condition + "'";
    for (const CLI::App* command : commands_of(*each))
      text += start + " -a " + command->get_name() + " -d '" + plain(command->get_description()) + "'\n";
    for (const CLI::Option* option : options_of(*each)) {
      text += start;
      for (const std::string& name : option->get_snames()) text += " -s " + name;
      for (const std::string& name : option->get_lnames()) text += " -l " + name;
      const std::vector<std::string> choices = choices_of(*option);
      if (!choices.empty())
        text += " -x -a '" + joined(choices) + "'";
      else if (takes_file(*option))
        text += " -r";
      else if (!value_of(*option).empty())
        text += " -x";
      text += " -d '" + plain(option->get_description()) + "'\n";
    }
  }
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string text =
      "#compdef corral\n# zsh completion of corral\n_corral() {\n  local path=corral word\n"
      "  for word in \"${words[@]:1:$((CURRENT-2))}\"; do\n    case \"$path $word\" in\n";
  std::string cases;
  for (const CLI::App* each : all_apps(app)) {
    const std::string path = path_of(*each, " ");
    if (each->get_parent()) text += "      '" + path + "') path='" + path + "' ;;\n";
    cases += "    '" + path + "')\n";
    if (!commands_of(*each).empty()) {
      cases += "      local -a commands=(";
      for (const CLI::App* command : commands_of(*each))
        cases += "\n        '" + command->get_name() + ":" + plain(command->get_description()) + "'";
      cases += ")\n      _describe command commands\n";
    }
    cases += "      local -a options=(";
    for (const CLI::Option* option : options_of(*each))
      for (const std::string& name : spellings(*option))
        cases += "\n        '" + name + ":" + plain(option->get_description()) + "'";
    cases += ")\n      [[ $PREFIX == -* ]] && _describe option options || _files ;;\n";
  }
  return text + "    esac\n  done\n  case $path in\n" + cases + "  esac\n}\n_corral \"$@\"\n";
}

}  // namespace

void add_manual(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("manual", "The pages of the manual and the completions of bash, zsh and fish, as files");
  auto folder = std::make_shared<std::string>();
  command
      ->add_option("-o,--output", *folder, "Folder for man/, bash-completion/, zsh/ and fish/, such as ~/.local/share")
      ->type_name("FOLDER")
      ->required();
  command->footer("Example:\n  corral manual -o ~/.local/share");
  command->callback([folder, &app, &action] {
    action = [folder, &app] {
      std::vector<FileContent> files;
      for (const ManualFile& file : manual_files(app, build_info().version)) {
        const std::string path = *folder + "/" + file.path;
        make_folder(std::filesystem::path(path).parent_path().string());
        files.push_back({path, file.text});
      }
      write_files(files);
      return kOk;
    };
  });
}

std::vector<ManualFile> manual_files(const CLI::App& app, const std::string& version) {
  std::vector<ManualFile> files;
  for (const CLI::App* each : all_apps(app))
    files.push_back({"man/man1/" + path_of(*each, "-") + ".1", page_of(*each, version)});
  files.push_back({"bash-completion/completions/corral", bash_completion(app)});
  files.push_back({"zsh/vendor-completions/_corral", zsh_completion(app)});
  files.push_back({"fish/vendor_completions.d/corral.fish", fish_completion(app)});
  return files;
}

}  // namespace corral
