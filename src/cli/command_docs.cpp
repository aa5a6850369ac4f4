// The hidden command that writes man pages and shell completions from the options of the others.
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/command_table.h"
#include "cli/completion.h"
#include "cli/man_page.h"
#include "common/atomic_file.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDocsExamples =
    "EXAMPLES\n"
    "  vantage docs man build/share/man/man1\n"
    "  vantage docs completion bash > ~/.local/share/bash-completion/completions/vantage\n"
    "  source <(vantage docs completion bash)\n";

struct DocsArguments {
  std::string kind, argument, output;
};

void write_man_pages(const std::vector<CommandRow>& table, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(ErrorCode::output_unwritable, "the folder cannot be made: " + error.message(), folder.string(),
                "name a folder that may be written");
  }
  for (const ManPage& page : man_pages(table)) write_whole_file(folder / page.file, page.text);
}

std::string completion(const std::vector<CommandRow>& table, const std::string& shell) {
  if (shell == "bash") return bash_completion(table);
  if (shell == "zsh") return zsh_completion(table);
  if (shell == "fish") return fish_completion(table);
  throw Error(ErrorCode::unknown_choice, "there is no completion for the shell '" + shell + "'", "command line, SHELL",
              "name bash, zsh or fish");
}

int run_docs(const CLI::App& app, const DocsArguments& options) {
  const std::vector<CommandRow> table = command_table(app);
  if (options.kind == "man") {
    write_man_pages(table, options.argument);
    return kSuccess;
  }
  const std::string text = completion(table, options.argument);
  if (options.output.empty()) {
    print(text);
  } else {
    write_whole_file(options.output, text);
  }
  return kSuccess;
}

}  // namespace

void add_docs(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("docs", "Write the man pages, or the completion script of a shell");
  command->group("");  // for packagers: not in --help
  auto options = std::make_shared<DocsArguments>();
  command->add_option("kind", options->kind, "man or completion")
      ->required()
      ->check(CLI::IsMember({"man", "completion"}))
      ->option_text("KIND");
  command
      ->add_option("folder_or_shell", options->argument,
                   "Of man: the folder to write to; of completion: bash, zsh or fish")
      ->required()
      ->option_text("FOLDER|SHELL");
  command->add_option("-o,--output", options->output, "Of completion: the file to write; default: standard output")
      ->option_text("FILE");
  command->footer(kDocsExamples + exit_code_table());
  command->callback([options, &app, &chosen] { chosen = [options, &app] { return run_docs(app, *options); }; });
}

}  // namespace vantage::cli
