// `stiction convert IN OUT`: logs from one format into the other, and recordings of drives into logs.
#include <fmt/format.h>

#include <fstream>
#include <memory>
#include <optional>

#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/log_input.hpp"
#include "host/cli/output.hpp"
#include "host/cli/progress.hpp"
#include "host/log/csv_log.hpp"
#include "host/log/mapping.hpp"
#include "host/log/mat_log.hpp"

namespace stiction::host {
namespace {

struct ConvertOptions {
  std::string in, out, map, columns, mat = "5";
};

void convert(const ConvertOptions& options) {
  const auto kind = std::filesystem::path(options.out).extension();
  if (kind != ".csv" && kind != ".mat")
    throw UsageError(fmt::format("OUT: found '{}'; expected a name that ends in .csv or .mat", options.out));
  Log log;
  if (options.map.empty()) {
    log = read_log_shown(options.in, options.columns);
  } else {
    const Progress progress("reading " + options.in);
    const auto mapping = read_mapping(options.map);
    log = apply_mapping(mapping, read_recording(options.in, mapping.table));
  }
  auto progress = std::make_optional<Progress>("writing " + options.out);
  PendingFile file(options.out);
  if (kind == ".csv")
    file.fill([&](const auto& path) { write_csv_log(path, log); });
  else
    file.fill([&](const auto& path) {
      write_mat_log(path, log, options.mat == "5" ? MatLevel::level_5 : MatLevel::level_7_3);
    });
  file.commit();
  progress.reset();
  fmt::print("{}: {} samples at {:.6g} ms", options.out, log.t.size(), log.period * 1e3);
  for (std::size_t k = 0; k < log.ignored.size(); ++k)
    fmt::print("{}{}", k == 0 ? "; not converted: " : ", ", log.ignored[k]);
  fmt::print("\n");
}

}  // namespace

void add_convert(CLI::App& program) {
  auto* command =
      program.add_subcommand("convert", "convert logs between CSV and MAT, and recordings of drives into logs");
  auto o = std::make_shared<ConvertOptions>();
  command->add_option("IN", o->in, "a log (CSV, MAT), a TwinCAT Scope export, a recorder's JSON or zip, any table")
      ->required()
      ->type_name("LOG");
  auto* columns = add_columns(*command, o->columns);
  add_output_file(*command, "OUT", o->out, "the log to write: NAME.csv or NAME.mat")->required();
  command->add_option("--map", o->map, "mapping file that names the channels of a recording (docs/formats.md)")
      ->type_name("FILE")
      ->excludes(columns);
  command->add_option("--mat", o->mat, "level of a MAT-file: 5 or 7.3")
      ->check(one_of({"5", "7.3"}))
      ->type_name("LEVEL")
      ->capture_default_str();
  command->callback([o] { convert(*o); });
}

}  // namespace stiction::host
