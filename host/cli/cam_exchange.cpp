// `stiction cam export` and `stiction cam import`: cams in the files of other makers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "firmware/machine/file/whole_file.hpp"
#include "host/cam/exchange.hpp"
#include "host/cli/cam_options.hpp"
#include "host/cli/choices.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/csv_marks.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/output.hpp"
#include "sim/cam/motion_file.hpp"
#include "sim/cam/motion_keys.hpp"

namespace stiction::host {
namespace {

struct ExchangeOptions {
  std::string format, dialect = "codesys", offset, columns = "xy", separator = ",", decimal = ".", master_unit,
                      slave_unit;
  double scaling = 1.0;
  bool no_header = false;
};

void add_exchange_options(CLI::App& command, ExchangeOptions& o) {
  std::vector<std::string> names;
  std::string help;
  for (const auto& format : exchange_formats()) {
    names.emplace_back(format.name);
    help += (help.empty() ? "" : "; ") + fmt::format("{}: {}", format.name, format.text);
  }
  command.add_option("--format", o.format, "format of the file. " + help)
      ->required()
      ->check(one_of(names))
      ->type_name("FORMAT");
  command
      .add_option("--dialect", o.dialect,
                  "how the controller scales its master M to X of the table: codesys X = scaling * M + offset, twincat "
                  "X = (M - offset) / scaling [codesys]")
      ->check(one_of({"codesys", "twincat"}))
      ->type_name("DIALECT");
  command.add_option("--master-scaling", o.scaling, "scaling of the master, above 0 [1]")->type_name("NUMBER");
  command.add_option("--master-offset", o.offset, "offset of the master, such as \"10 deg\" [0]")->type_name("OFFSET");
  command.add_option("--master-unit", o.master_unit, "unit of master values in the file [deg or mm]")
      ->type_name("UNIT");
  command.add_option("--slave-unit", o.slave_unit, "unit of slave values in the file [deg or mm]")->type_name("UNIT");
  command.add_option("--columns", o.columns, "of csv: x master, y slave, v and a derivatives, in their order [xy]")
      ->type_name("COLUMNS");
  command.add_option("--separator", o.separator, "of csv: one character, or tab [,]")->type_name("CHARACTER");
  command.add_option("--decimal", o.decimal, "of csv: decimal mark, a point or a comma [.]")->type_name("MARK");
  command.add_flag("--no-header", o.no_header, "of csv: the first line is a row of numbers");
}

CsvLayout csv_layout(const ExchangeOptions& o) {
  CsvLayout layout;
  layout.columns = o.columns;
  std::string sorted = o.columns;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != "xy" && sorted != "vxy" && sorted != "avxy")
    throw UsageError(
        fmt::format("--columns: found '{}'; expected x and y, with v or with v and a, each once", o.columns));
  const auto [separator, decimal] = csv_marks(o.separator, o.decimal);
  layout.separator = separator;
  layout.decimal = decimal;
  layout.header = !o.no_header;
  return layout;
}

ExchangeSettings settings_of(const ExchangeOptions& o, const sim::cam::Cam& cam) {
  ExchangeSettings settings;
  settings.dialect = o.dialect == "twincat" ? Dialect::twincat : Dialect::codesys;
  settings.scaling = o.scaling;
  if (!(o.scaling > 0.0)) throw UsageError(fmt::format("--master-scaling: found {}; expected more than 0", o.scaling));
  const std::string master(unit_of(cam.master)), slave(unit_of(cam.slave));
  if (!o.offset.empty()) settings.offset = cam_quantity("--master-offset", o.offset, master, "a quantity in " + master);
  if (!o.master_unit.empty())
    settings.master_unit = cam_quantity("--master-unit", "1 " + o.master_unit, master, "a unit of " + master);
  if (!o.slave_unit.empty())
    settings.slave_unit = cam_quantity("--slave-unit", "1 " + o.slave_unit, slave, "a unit of " + slave);
  settings.csv = csv_layout(o);
  return settings;
}

struct ExportOptions {
  MotionOptions motion;
  ExchangeOptions exchange;
  int points = 0;
  std::string out;
};

void run_export(const ExportOptions& options) {
  const auto cam = options.motion.one();
  const auto& format = exchange_format(options.exchange.format);
  auto settings = settings_of(options.exchange, cam);
  if (options.points != 0) settings.points = options.points;
  PendingFile file(options.out);
  const auto motion = sim::cam::compose(cam);
  const auto text = exported(motion, format, settings);
  const auto error = exchange_error(motion, text, format, settings);
  file.write(text);
  file.commit();
  constexpr const char* joins[] = {"joined by straight lines", "joined by a cubic spline",
                                   "joined by polynomials of 5th degree through equidistant points",
                                   "joined through the derivatives in the file"};
  const auto where = [&](double place) {
    return cam.master == sim::cam::Coordinate::rotary ? fmt::format("{:.5g}°", place * 57.295779513082321)
                                                      : fmt::format("{:.5g} mm", place * 1e3);
  };
  const auto unit = unit_of(cam.slave);
  fmt::print("{}: {} of {}, {}\n", options.out, format.name, cam.name,
             joins[static_cast<std::size_t>(format.importer)]);
  fmt::print("error of the position: at most {:.3g} {}, at {}\n", std::abs(error.position.value), unit,
             where(error.position.place));
  fmt::print("error of the acceleration: at most {:.3g} % of its peak, at {}{}\n",
             100.0 * std::abs(error.acceleration.value) / error.acceleration_peak, where(error.acceleration.place),
             format.importer == Importer::linear ? ", since lines have none" : "");
  if (format.importer != Importer::linear) return;
  fmt::print("step of the speed at a point: at most {:.3g} {}, at {}\n", std::abs(error.speed_step.value),
             fmt::format("{}/{}", unit, unit_of(cam.master)), where(error.speed_step.place));
}

struct ImportOptions {
  std::string file, out, name = "imported", master = "rotary", slave = "rotary";
  ExchangeOptions exchange;
};

void run_import(const ImportOptions& options) {
  const auto kind = [](const std::string& text) {
    return text == "linear" ? sim::cam::Coordinate::linear : sim::cam::Coordinate::rotary;
  };
  sim::cam::Cam like{.name = options.name, .master = kind(options.master), .slave = kind(options.slave)};
  const auto settings = settings_of(options.exchange, like);
  const auto& format = exchange_format(options.exchange.format);
  const auto text = machine::read_whole_file(options.file, fmt::format("a cam in the format {}", format.name));
  sim::cam::Cam cam;
  try {
    cam = imported(text, format, settings, like);
  } catch (const sim::cam::CamError& error) {
    throw UsageError(fmt::format("{}: {}", options.file, error.what()));
  }
  PendingFile file(options.out);
  file.write(sim::cam::motion_text({cam}));
  file.commit();
  fmt::print("{}: {} points over {:.6g} {}, {}\n", options.out, cam.segments[0].points->master.size(), cam.cycle(),
             unit_of(cam.master), cam.periodic ? "periodic" : "once");
}

bool is_cam_name(const std::string& name) {
  return !name.empty() && name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                              std::string::npos;
}

}  // namespace

void add_cam_exchange(CLI::App& cam) {
  auto* out =
      cam.add_subcommand("export", "write a motion in the format of a different maker, with the error that it causes");
  auto e = std::make_shared<ExportOptions>();
  e->motion.add_to(*out);
  add_exchange_options(*out, e->exchange);
  out->add_option("--points", e->points, "points of the cycle [the format's usual number]")
      ->check(whole_number_between(2, 1000000))
      ->type_name("N");
  add_output_file(*out, "--out,-o", e->out, "file to write")->required();
  out->callback([e] { run_export(*e); });

  auto* in = cam.add_subcommand("import", "make a motion file from a cam in the format of a different maker");
  auto i = std::make_shared<ImportOptions>();
  in->add_option("FILE", i->file, "file to read")->required()->type_name("FILE");
  add_exchange_options(*in, i->exchange);
  add_output_file(*in, "--out,-o", i->out, "motion file to write")->required();
  in->add_option("--name", i->name, "name of the cam in the motion file [imported]")
      ->check([](const std::string& name) {
        return is_cam_name(name) ? std::string() : "found '" + name + "'; expected letters, digits, - and _";
      })
      ->type_name("NAME");
  in->add_option("--master", i->master, "kind of the master [rotary]")
      ->check(one_of({"rotary", "linear"}))
      ->type_name("KIND");
  in->add_option("--slave", i->slave, "kind of the slave [rotary]")
      ->check(one_of({"rotary", "linear"}))
      ->type_name("KIND");
  in->callback([i] { run_import(*i); });
}

}  // namespace stiction::host
