#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/cam/exchange.hpp"

namespace stiction::host {
namespace {

using sim::cam::CamError;

std::string number_text(double value, int decimals, char decimal = '.') {
  auto text = decimals < 0 ? fmt::format("{}", value) : fmt::format("{:.{}f}", value, decimals);
  if (decimal != '.') std::replace(text.begin(), text.end(), '.', decimal);
  return text;
}

// One row of the motion in the units of the file.
struct Sample {
  double x, y, v, a;
};

std::vector<Sample> samples_of(const sim::cam::Motion& motion, int points, const ExchangeSettings& settings) {
  const auto [master, slave] = detail::units_of(settings, motion.cam);
  const double begin = motion.curve.begin(), length = motion.curve.length();
  // The table's master runs as the axis' own does but for a factor.
  const double rate = detail::table_master(settings, 1.0) - detail::table_master(settings, 0.0);
  std::vector<Sample> samples;
  for (int k = 0; k < points; ++k) {
    const double x = k + 1 == points ? motion.curve.end() : begin + length * k / (points - 1);
    const auto side = k + 1 == points ? sim::cam::Side::left : sim::cam::Side::right;
    const double speed = motion.curve.derivative(x, 1, side) / rate;
    const double acceleration = motion.curve.derivative(x, 2, side) / (rate * rate);
    samples.push_back({detail::table_master(settings, x) / master, motion.curve.derivative(x, 0, side) / slave,
                       speed * master / slave, acceleration * master * master / slave});
  }
  return samples;
}

int points_of(const sim::cam::Motion& motion, const ExchangeFormat& format, const ExchangeSettings& settings) {
  const int points = settings.points.value_or(format.usual_points);
  if (points < format.least_points || points > format.most_points)
    throw CamError(fmt::format("--points: found {}; expected {} to {}, as {} holds them", points, format.least_points,
                               format.most_points, format.name));
  const auto [master, slave] = detail::units_of(settings, motion.cam);
  const double distance = motion.curve.length() / master / (points - 1);
  if (distance < format.least_distance * (1.0 - 1e-9))
    throw CamError(
        fmt::format("--points: found {}, {:.3g} apart; expected at least {} between points, as {} reads them", points,
                    distance, format.least_distance, format.name));
  return points;
}

std::string pairs(const std::vector<Sample>& samples, int decimals, std::string_view between,
                  std::string_view behind = "") {
  std::string text;
  for (const auto& s : samples)
    text += fmt::format("{}{}{}{}\n", number_text(s.x, decimals), between, number_text(s.y, decimals), behind);
  return text;
}

std::string csv_text(const std::vector<Sample>& samples, const CsvLayout& layout) {
  std::string text;
  const auto row = [&](auto&& cell) {
    for (std::size_t k = 0; k < layout.columns.size(); ++k) {
      if (k > 0) text += layout.separator;
      text += cell(layout.columns[k]);
    }
    text += '\n';
  };
  if (layout.header)
    row([](char c) { return c == 'x' ? "master" : c == 'y' ? "slave" : c == 'v' ? "speed" : "acceleration"; });
  for (const auto& s : samples)
    row([&](char c) {
      return number_text(c == 'x' ? s.x : c == 'y' ? s.y : c == 'v' ? s.v : s.a, -1, layout.decimal);
    });
  return text;
}

std::string xyva_text(const std::vector<Sample>& samples, int decimals) {
  std::string text = "X,Y,V,A\n";
  for (const auto& s : samples)
    text += fmt::format("{},{},{},{}\n", number_text(s.x, decimals), number_text(s.y, decimals),
                        number_text(s.v, decimals), number_text(s.a, decimals));
  return text;
}

// Kollmorgen's importer divides each column by its largest value.
void require_positive_peak(const std::vector<Sample>& samples) {
  const auto highest = std::max_element(samples.begin(), samples.end(), [](auto& a, auto& b) { return a.y < b.y; });
  if (!(highest->y > 0.0) || !(samples.back().x > 0.0))
    throw CamError(
        "kollmorgen-csv: found no position above 0; expected one, since the importer divides by the largest");
}

}  // namespace

const std::vector<ExchangeFormat>& exchange_formats() {
  static const std::vector<ExchangeFormat> formats{
      {"sew", "SEW: a line with the count, then pairs", "a count of rows", 1024, 2, 16383, 0.0, Importer::linear, 6},
      {"kollmorgen-csv", "Kollmorgen KAS: CYCLIC, TABLE_BEGIN, X;Y;SPLINE", "CYCLIC;YES", 361, 5, 16383, 0.0,
       Importer::cubic, 9},
      {"isg", "ISG and Beckhoff CNC: a header, Begintable, pairs", "Begintable", 360, 2, 360, 0.1, Importer::linear, 6},
      {"codesys-xy", "CODESYS: pairs, read at equidistant points and joined by Poly5", "pairs", 361, 3, 16383, 0.0,
       Importer::quintic, 9},
      {"xyva", "rows of master, slave, speed, acceleration", "X,Y,V,A", 361, 2, 16383, 0.0, Importer::given, -1},
      {"csv", "a layout of your own: columns, separator, decimal mark, units, header", "columns", 361, 2, 1000000, 0.0,
       Importer::cubic, -1},
  };
  return formats;
}

const ExchangeFormat& exchange_format(std::string_view name) {
  std::string known;
  for (const auto& format : exchange_formats()) {
    if (format.name == name) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.name);
  }
  throw CamError(fmt::format("--format: found '{}'; expected one of {}", name, known));
}

detail::ExchangeUnits detail::units_of(const ExchangeSettings& settings, const sim::cam::Cam& cam) {
  const auto usual = [](sim::cam::Coordinate kind) {
    return kind == sim::cam::Coordinate::rotary ? std::numbers::pi / 180.0 : 1e-3;
  };
  return {settings.master_unit > 0.0 ? settings.master_unit : usual(cam.master),
          settings.slave_unit > 0.0 ? settings.slave_unit : usual(cam.slave)};
}

double detail::table_master(const ExchangeSettings& settings, double master) {
  return settings.dialect == Dialect::codesys ? settings.scaling * master + settings.offset
                                              : (master - settings.offset) / settings.scaling;
}
double detail::axis_master(const ExchangeSettings& settings, double x) {
  return settings.dialect == Dialect::codesys ? (x - settings.offset) / settings.scaling
                                              : x * settings.scaling + settings.offset;
}

std::string exported(const sim::cam::Motion& motion, const ExchangeFormat& format, const ExchangeSettings& settings) {
  if (!(settings.scaling > 0.0)) throw CamError("--master-scaling: found 0 or less; expected more than 0");
  const auto samples = samples_of(motion, points_of(motion, format, settings), settings);
  if (format.name == "sew") return fmt::format("{}\n", samples.size()) + pairs(samples, format.decimals, "\t");
  if (format.name == "kollmorgen-csv") {
    require_positive_peak(samples);
    return fmt::format("CYCLIC;{}\nTABLE_BEGIN\n", motion.cam.periodic ? "YES" : "NO") +
           pairs(samples, format.decimals, ";", ";SPLINE") + "TABLE_END\n";
  }
  if (format.name == "isg") return "; cam table\nBegintable\n" + pairs(samples, format.decimals, " ") + "Endtable\n";
  if (format.name == "codesys-xy") return pairs(samples, format.decimals, " ");
  if (format.name == "xyva") return xyva_text(samples, format.decimals);
  return csv_text(samples, settings.csv);
}

}  // namespace stiction::host
