#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/conversion.h"
#include "cli/file_options.h"
#include "cli/options.h"
#include "cli/progress_bar.h"
#include "formats/format.h"
#include "support/errors.h"

namespace clothbrdf {
namespace {

using Json = nlohmann::ordered_json;

struct ConvertOptions {
  std::string in;
  std::string out;
  std::optional<std::string> grid;
  std::optional<std::string> threads;
  FileOptions file;
  bool isotropic = false;
  bool json = false;
};

void report(const ConvertOptions& options, const ConversionWish& wish, const Conversion& conversion,
            std::uint64_t bytes, const std::optional<ChannelDifference>& error) {
  const Layout layout = conversion.format->layout(conversion.spec, wish.write);
  const std::size_t channels = conversion.spec.channels.size();
  if (options.json) {
    Json json = {{"file", options.out},
                 {"from", options.in},
                 {"format", conversion.format->name},
                 {"grid", layout.description},
                 {"cells", layout.cells},
                 {"channels", channels},
                 {"bytes", bytes},
                 {"lost", conversion.lost}};
    if (error) {
      json["error"] = {{"at", conversion.compared_at},
                       {"rms", error->rms},
                       {"p99", error->p99},
                       {"max", error->max}};
    }
    std::cout << json.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  std::cout << options.out << ": " << conversion.format->name << ' ' << layout.description << ", "
            << with_commas(layout.cells) << " cells of " << channels << " channels, "
            << with_commas(bytes) << " bytes, from " << options.in << '\n';
  for (const std::string& what : conversion.lost) std::cout << "  lost: " << what << '\n';
  if (error) {
    std::cout << std::setprecision(3) << "  relative error " << conversion.compared_at << ": rms "
              << error->rms << ", p99 " << error->p99 << ", max " << error->max << '\n';
  }
  if (conversion.lost.empty()) std::cout << "  lost: nothing\n";
}

void convert(const ConvertOptions& options) {
  const int threads = threads_of(options.threads);
  // Before a large table is read.
  format_for(options.out);
  const std::vector<FileToWrite> files = files_to_write(options.out, options.file);
  if (files.size() > 1) throw InputError("--flavour: 'both' is not for convert: rgb or spectral");
  const Table source = read_table(options.in);
  ProgressBar bar;
  ConversionWish wish{
      .out = options.out, .grid = options.grid, .isotropic = options.isotropic, .write = {}};
  wish.write = files.front().options;
  wish.write.workers = {threads, &bar.progress()};
  Conversion conversion = plan_conversion(source, wish);
  AtomicFile file(options.out);
  const std::optional<ChannelDifference> error = run_conversion(source, wish, conversion, file);
  bar.clear();
  report(options, wish, conversion, file.size(), error);
}

}  // namespace

void add_convert_command(CLI::App& program) {
  const auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand(
      "convert",
      "Writes a table in another format or on another grid, and says what is lost. The grid stays "
      "where the format can hold it.\n"
      "Example: clothbrdf convert silk.exr silk.binary");
  command->add_option("IN", options->in, "table to read (" + table_endings() + ")")
      ->required()
      ->type_name("FILE");
  command->add_option("OUT", options->out, "table to write; the format follows the ending")
      ->required()
      ->type_name("FILE");
  add_text_option(*command, "--grid", options->grid, "GRID",
                  "halfdiff3d[:THxTDxPD], halfdiff4d[:THxPHxTDxPD] or inout[:TIxPIxTOxPO]");
  command->add_flag("--isotropic", options->isotropic,
                    "the mean over rotations of the cloth: smaller files, and no weave");
  add_file_options(*command, options->file);
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "say what was written as one JSON object");
  command->callback([options] { convert(*options); });
}

}  // namespace clothbrdf
