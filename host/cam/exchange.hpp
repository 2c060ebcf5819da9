// Cams in the files of other makers: pairs of master and slave as text, and the rows of X, Y, V, A. What a format
// cannot hold is told by the error that its importer makes of it, which is simulated.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/cam/characteristics.hpp"
#include "sim/cam/motion.hpp"

namespace stiction::host {

// How an importer joins the points of a file.
enum class Importer {
  linear,   // straight lines
  cubic,    // a cubic spline
  quintic,  // polynomials of 5th degree through equidistant points
  given     // through the derivatives that the file has
};

// Controllers that scale a table differently: X is the table's master, M the axis'.
enum class Dialect {
  codesys,  // X = scaling * M + offset
  twincat   // X = (M - offset) / scaling
};

// Of --format csv: the user's own layout.
struct CsvLayout {
  std::string columns = "xy";  // x master, y slave, v and a derivatives, in the order of the file
  char separator = ',';
  char decimal = '.';
  bool header = true;
};

struct ExchangeSettings {
  std::optional<int> points{};  // of a cycle; none: the format's usual number
  Dialect dialect = Dialect::codesys;
  double scaling = 1.0;                        // of the master
  double offset = 0.0;                         // of the master, in its unit
  double master_unit = 0.0, slave_unit = 0.0;  // in SI; 0: degrees and millimetres
  CsvLayout csv{};
};

struct ExchangeFormat {
  std::string_view name;
  std::string_view text;   // for the list of formats
  std::string_view marks;  // what a file of it begins with, for messages
  int usual_points, least_points, most_points;
  double least_distance;  // of masters, degrees or mm; 0: any
  Importer importer;
  int decimals;  // behind the point; -1: all digits of a double
};

const std::vector<ExchangeFormat>& exchange_formats();
// Throws sim::cam::CamError for an unknown name, with those that there are.
const ExchangeFormat& exchange_format(std::string_view name);

// The text of a file. Throws CamError for a number of points that the format cannot hold, and for a motion that it
// cannot. `motion` as `format` has it, with those `settings`.
std::string exported(const sim::cam::Motion& motion, const ExchangeFormat& format, const ExchangeSettings& settings);

// The cam that a file of `format` holds, in one segment of points. `text`: the content; `settings`: as it was exported;
// `like`: kinds of master and slave, which no such file says. Throws CamError with the line, and with the format that
// the file looks like where it is a different one.
sim::cam::Cam imported(const std::string& text, const ExchangeFormat& format, const ExchangeSettings& settings,
                       const sim::cam::Cam& like);

// The format that `text` looks like; empty where it looks like none.
std::string_view looks_like(const std::string& text);

// The largest differences from a motion, and where.
struct ExchangeError {
  sim::cam::Peak position, acceleration;  // of the slave and over the master's square; places of the master
  double acceleration_peak = 0.0;         // of the motion, for comparison
  sim::cam::Peak speed_step;              // of an importer that joins by lines: the largest one, at a point
};
// What the importer of `format` makes of the `text` of a file that was exported from `motion` with those `settings`.
ExchangeError exchange_error(const sim::cam::Motion& motion, const std::string& text, const ExchangeFormat& format,
                             const ExchangeSettings& settings);

namespace detail {
// Rows of a file in SI.
struct ExchangeRows {
  std::vector<double> master, slave, speed, acceleration;
  std::optional<bool> cyclic;
};
// `text` of `format` with those `settings`; `like`: kinds of master and slave. Throws CamError.
ExchangeRows read_rows(const std::string& text, const ExchangeFormat& format, const ExchangeSettings& settings,
                       const sim::cam::Cam& like);
struct ExchangeUnits {
  double master, slave;
};
ExchangeUnits units_of(const ExchangeSettings& settings, const sim::cam::Cam& cam);
// The table's master X of the axis' master M, and back.
double table_master(const ExchangeSettings& settings, double master);
double axis_master(const ExchangeSettings& settings, double x);
}  // namespace detail

}  // namespace stiction::host
