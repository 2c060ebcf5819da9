// Formats of other makers: round trips, the error that is told, dialects, and files that are none.
#include "host/cam/exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/sim/cam/random_motion.hpp"

namespace stiction::host {
namespace {

using sim::cam::RandomMotion;

sim::cam::Motion any_motion(std::uint64_t seed) {
  RandomMotion random(seed);
  auto cam = seed % 2 == 0 ? random.rests(3) : random.septics(3);
  cam.start = 3.0;  // above 0 somewhere
  // The draw closes at its own start.
  cam.segments.back().stroke = 0.0;
  cam.segments.back().stroke = cam.start - cam.position_of(cam.segments.size());
  return sim::cam::compose(cam);
}

ExchangeSettings settings_for(const ExchangeFormat& format) {
  ExchangeSettings settings;
  if (format.name == "csv") settings.csv = {"avyx", ';', ',', true};
  return settings;
}

double on_lines(const sim::cam::PointTable& points, double x) {
  const auto behind = std::upper_bound(points.master.begin() + 1, points.master.end() - 1, x) - points.master.begin();
  const auto k = static_cast<std::size_t>(behind);
  const double share = (x - points.master[k - 1]) / (points.master[k] - points.master[k - 1]);
  return points.slave[k - 1] + share * (points.slave[k] - points.slave[k - 1]);
}

std::string problem(const std::string& text, const std::string& format, const ExchangeSettings& settings = {}) {
  try {
    imported(text, exchange_format(format), settings, {.name = "a"});
  } catch (const sim::cam::CamError& error) {
    return error.what();
  }
  return "";
}

// The points come back within the rounding of the file, and between them within the error that is told.
TEST(CamExchange, RoundTripsHoldWhatTheFormatHolds) {
  for (const auto& format : exchange_formats())
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const auto motion = any_motion(seed);
      const auto settings = settings_for(format);
      const auto text = exported(motion, format, settings);
      EXPECT_EQ(looks_like(text) == format.name, format.name != "csv") << format.name;
      const auto back = sim::cam::compose(imported(text, format, settings, {.name = "back"}));
      EXPECT_TRUE(back.cam.periodic) << format.name << seed;
      // Half a unit of the last decimal in degrees, of the slave and, by its speed, of the master.
      const double digit =
          format.decimals < 0 ? 1e-12 : 0.5 * std::pow(10.0, -format.decimals) * std::numbers::pi / 180.0;
      const double speed = extremes(motion.curve, 1).magnitude();
      const auto& points = *back.cam.segments[0].points;
      for (std::size_t k = 0; k < points.master.size(); ++k)
        ASSERT_NEAR(points.slave[k], motion.curve(std::min(points.master[k], motion.curve.end())),
                    2.0 * digit * (1.0 + speed) + 1e-12)
            << format.name;
    }
}

TEST(CamExchange, TheToldErrorHoldsAtPlacesThatWereNotLookedAt) {
  std::mt19937_64 engine(7);
  for (const auto& format : exchange_formats()) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      const auto motion = any_motion(seed);
      const auto settings = settings_for(format);
      const auto text = exported(motion, format, settings);
      const auto told = exchange_error(motion, text, format, settings);
      const auto back = sim::cam::compose(imported(text, format, settings, {.name = "back"}));
      const auto& points = *back.cam.segments[0].points;
      const double shift = points.slave.front() - back.cam.start;
      // Of most formats the importer is the interpolation that the imported motion has; of the others straight lines.
      const auto read_back = [&](double x) {
        return format.importer == Importer::linear ? on_lines(points, x) : back.curve(x) + shift;
      };
      for (int k = 0; k < 3000; ++k) {
        const double x = std::min(motion.curve.end(), back.curve.end()) * static_cast<double>(engine() >> 11) * 0x1p-53;
        ASSERT_LE(std::fabs(read_back(x) - motion.curve(x)), std::fabs(told.position.value) + 1e-9)
            << format.name << " " << seed << " " << x;
      }
    }
  }
}

// Lines through points that are h apart: the speed steps by what the acceleration sums up to over h, at most h times
// its peak, and between the points all of the acceleration is missing.
TEST(CamExchange, LinesHaveTheAccelerationInStepsOfTheSpeed) {
  sim::cam::Cam cam{.name = "sine"};
  cam.segments = {{.length = std::numbers::pi, .stroke = 1.0, .law = "sloping_sine"},
                  {.length = std::numbers::pi, .stroke = -1.0, .law = "sloping_sine"}};
  const auto motion = sim::cam::compose(cam);
  for (const auto* name : {"sew", "isg"}) {
    const auto& format = exchange_format(name);
    ExchangeSettings settings;
    settings.points = 361;
    if (format.most_points < 361) settings.points = 360;
    const auto error = exchange_error(motion, exported(motion, format, settings), format, settings);
    const double peak = 2.0 / std::numbers::pi, h = 2.0 * std::numbers::pi / (*settings.points - 1);
    EXPECT_NEAR(error.acceleration_peak, peak, 1e-9);
    EXPECT_NEAR(std::fabs(error.acceleration.value), peak, 0.02 * peak) << name;
    EXPECT_NEAR(std::fabs(error.speed_step.value), h * peak, 2e-3 * h * peak) << name;
  }
}

TEST(CamExchange, MorePointsMakeTheErrorSmallerButForTheRounding) {
  const auto motion = any_motion(2);
  const auto& format = exchange_format("codesys-xy");
  double last = 1.0;
  for (const int points : {19, 73, 289}) {
    ExchangeSettings settings;
    settings.points = points;
    const auto error = exchange_error(motion, exported(motion, format, settings), format, settings);
    EXPECT_LT(std::fabs(error.position.value), last);
    last = std::fabs(error.position.value);
  }
}

// CODESYS' scaling and TwinCAT's reciprocal with the offset that belongs to it write the same table, and either is read
// back as the same motion.
TEST(CamExchange, DialectsGiveEqualMotions) {
  const auto motion = any_motion(4);
  const auto& format = exchange_format("xyva");
  ExchangeSettings codesys;
  codesys.scaling = 2.0;
  codesys.offset = 0.5;
  ExchangeSettings twincat;
  twincat.dialect = Dialect::twincat;
  twincat.scaling = 0.5;
  twincat.offset = -0.25;
  const auto one = sim::cam::compose(imported(exported(motion, format, codesys), format, codesys, {.name = "a"}));
  const auto two = sim::cam::compose(imported(exported(motion, format, twincat), format, twincat, {.name = "a"}));
  const auto crossed = sim::cam::compose(imported(exported(motion, format, codesys), format, twincat, {.name = "a"}));
  for (double x = 0.0; x < motion.curve.end(); x += 0.01)
    for (const auto* each : {&one, &two, &crossed}) ASSERT_NEAR(each->curve(x), motion.curve(x), 1e-6);
}

TEST(CamExchange, RefusesWhatTheFormatCannotHold) {
  const auto motion = any_motion(2);
  const auto with = [&](const char* format, int points) {
    ExchangeSettings settings;
    settings.points = points;
    return exported(motion, exchange_format(format), settings);
  };
  EXPECT_THROW(with("isg", 361), sim::cam::CamError);
  EXPECT_THROW(with("kollmorgen-csv", 4), sim::cam::CamError);
  EXPECT_THROW(with("sew", 16384), sim::cam::CamError);
  EXPECT_NO_THROW(with("sew", 16383));
  EXPECT_THROW(exchange_format("dxf"), sim::cam::CamError);
  sim::cam::Cam below{.name = "below", .slave = sim::cam::Coordinate::linear};
  below.segments = {{.length = 3.0, .stroke = -1.0, .law = "modified_sine"},
                    {.length = 3.0, .stroke = 1.0, .law = "modified_sine"}};
  EXPECT_THROW(exported(sim::cam::compose(below), exchange_format("kollmorgen-csv"), {}), sim::cam::CamError);
  // Less than a tenth of a degree apart.
  sim::cam::Cam brief{.name = "brief"};
  brief.segments = {{.length = 0.1, .stroke = 1.0, .law = "modified_sine"},
                    {.length = 0.1, .stroke = -1.0, .law = "modified_sine"}};
  EXPECT_THROW(exported(sim::cam::compose(brief), exchange_format("isg"), {}), sim::cam::CamError);
}

TEST(CamExchange, SaysWhatAForeignFileLooksLike) {
  const auto motion = any_motion(2);
  for (const auto& wrong : exchange_formats())
    for (const auto& right : exchange_formats()) {
      if (wrong.name == right.name || right.name == "csv") continue;
      const auto said = problem(exported(motion, right, {}), std::string(wrong.name));
      if (wrong.name == "csv" && right.name == "csv") continue;
      EXPECT_NE(said.find("looks like " + std::string(right.name)), std::string::npos)
          << right.name << " read as " << wrong.name << ": " << said;
    }
  EXPECT_NE(problem("schema = \"stiction.cam/1\"\n", "sew").find("a motion file"), std::string::npos);
}

TEST(CamExchange, RefusesRowsThatAreNone) {
  EXPECT_NE(problem("", "sew"), "");
  EXPECT_NE(problem("1\n0 0\n", "sew").find("one row"), std::string::npos);
  EXPECT_NE(problem("3\n0 0\n1 1\n", "sew").find("count"), std::string::npos);
  EXPECT_NE(problem("2\n0 0\n0 1\n", "sew").find("a master above 0"), std::string::npos);
  EXPECT_NE(problem("3\n0 0\n2 1\n1 1\n", "sew").find("line 4"), std::string::npos);
  EXPECT_NE(problem("2\n0 0\n1,5 1\n", "sew").find("decimal comma"), std::string::npos);
  EXPECT_NE(problem("2\n0 0\n1 nan\n", "sew").find("a number"), std::string::npos);
  EXPECT_NE(problem("2\n0 0\n1\n", "sew").find("2 cells"), std::string::npos);
  ExchangeSettings comma;
  comma.csv = {"xy", ';', ',', false};
  EXPECT_EQ(problem("0;0\n1,5;2\n3;0\n", "csv", comma), "");
}

}  // namespace
}  // namespace stiction::host
