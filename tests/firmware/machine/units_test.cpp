// Quantities "NUMBER UNIT": every unit the machine files use, and everything that must not pass.
#include "firmware/machine/file/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace stiction::machine {
namespace {

struct Quantity {
  std::string text;
  std::string si_unit;
  double value;
};

std::string error_of(const std::string& text, const std::string& si_unit) {
  try {
    const double value = parse_quantity(text, si_unit);
    return "accepted as " + std::to_string(value);
  } catch (const UnitError& error) {
    return error.what();
  }
}

TEST(Units, EveryUnitOfTheMachineFilesHasItsSiValue) {
  const std::vector<Quantity> quantities{
      {"83.3 1/s", "1/s", 83.3},
      {"5 m/min/mm", "1/s", 5.0 / 60.0 * 1000.0},
      {"16 m/min", "m/s", 16.0 / 60.0},
      {"600 A s/m", "A s/m", 600.0},
      {"62.8 V s/m", "V s/m", 62.8},
      {"62.5 us", "s", 62.5e-6},
      {"1 ms", "s", 1e-3},
      {"72 mm", "m", 72e-3},
      {"1 um", "m", 1e-6},
      {"1 nm", "m", 1e-9},
      {"430 N s/m", "N s/m", 430.0},
      {"8e5 N/m", "N/m", 8e5},
      {"25 degC", "K", 298.15},
      {"1.8 Ohm", "Ohm", 1.8},
      {"18 mH", "H", 18e-3},
      {"94 N/A", "N/A", 94.0},
      {"35.15 N/V", "N/V", 35.15},
      {"35 V/A", "V/A", 35.0},
      {"2000 Hz", "Hz", 2000.0},
      {"225 kg", "kg", 225.0},
      {"20 m/s^2", "m/s^2", 20.0},
      {"70 A", "A", 70.0},
      {"600 V", "V", 600.0},
      {"-3.5 N", "N", -3.5},
      {"2 h", "s", 7200.0},
      {"5 %", "1", 0.05},
      {"0.7", "1", 0.7},
      {"+2 kHz", "Hz", 2000.0},
      {"  7  µm ", "m", 7e-6},
      {"3 m s-1", "m/s", 3.0},
  };
  for (const Quantity& q : quantities) EXPECT_DOUBLE_EQ(parse_quantity(q.text, q.si_unit), q.value) << q.text;
}

TEST(Units, DecimalPrefixesRoundLikeTheCompilersLiterals) {
  EXPECT_EQ(parse_quantity("62.5 us", "s"), 62.5e-6);
  EXPECT_EQ(parse_quantity("15.625 us", "s"), 15.625e-6);
  EXPECT_EQ(parse_quantity("4.4 ms", "s"), 4.4e-3);
  EXPECT_EQ(parse_quantity("72 mm", "m"), 72e-3);
  EXPECT_EQ(parse_quantity("7 nm", "m"), 7e-9);
  EXPECT_EQ(parse_quantity("48 m/min", "m/s"), 48.0 / 60.0);
}

TEST(Units, WrongDimensionIsRefusedNamingBothDimensions) {
  EXPECT_EQ(error_of("3 A", "kg"), "dimension A, not kg");
  EXPECT_EQ(error_of("94 N/A", "N/V"), "dimension m kg s^-2 A^-1, not m^-1 s A");
  EXPECT_EQ(error_of("600 V s/m", "A s/m"), "dimension m kg s^-2 A^-1, not m^-1 s A");
  EXPECT_EQ(error_of("0.7 kg", "1"), "dimension kg, not 1");
}

// UDUNITS-2 itself converts "5 ms" to 200 1/s.
TEST(Units, ReciprocalUnitIsNoMatch) { EXPECT_EQ(error_of("5 ms", "1/s"), "dimension s, not s^-1"); }

TEST(Units, RotationalSpeedIsNoFrequency) { EXPECT_EQ(error_of("3000 rpm", "Hz"), "dimension s^-1 rad, not s^-1"); }

TEST(Units, QuantityWithoutUnitIsRefused) {
  EXPECT_EQ(error_of("225", "kg"), "no unit");
  EXPECT_EQ(error_of("0", "m"), "no unit");
}

TEST(Units, UnknownUnitIsNamed) {
  EXPECT_EQ(error_of("3 kq", "kg"), "unknown unit \"kq\"; did you mean \"kg\"?");
  EXPECT_EQ(error_of("3 Nm", "N m"), "unknown unit \"Nm\"; did you mean \"N m\"?");
  EXPECT_EQ(error_of("3 kg # heavy", "kg"), "unknown unit \"kg # heavy\"");
}

TEST(Units, NumbersAndOriginsInsideAUnitAreRefused) {
  for (const char* text : {"72 10 mm", "72 mm 5", "72 mm.5", "72 m @ 5", "72 1 m", "72 mm -3", "72 2/m"})
    EXPECT_TRUE(error_of(text, "m").starts_with("unknown unit")) << text;
}

TEST(Units, NumbersThatAreNotFiniteAreRefused) {
  for (const char* text : {"nan kg", "inf kg", "-inf kg", "infinity kg", "NaN kg"})
    EXPECT_EQ(error_of(text, "kg"), "not a finite number") << text;
  EXPECT_EQ(error_of("1e999 kg", "kg"), "beyond the range of numbers");
  EXPECT_EQ(error_of("1e308 km", "m"), "beyond the range of numbers");
}

TEST(Units, GarbageIsRefused) {
  for (const char* text : {"", " ", "kg", "kg 3", "--3 kg", "+-3 kg", "0x10 kg", "3kg", "3,5 kg", "1_000 kg"})
    EXPECT_TRUE(error_of(text, "kg").starts_with("not NUMBER UNIT")) << text << ": " << error_of(text, "kg");
}

TEST(Units, ControlCharactersAreRefusedNotReadPast) {
  using namespace std::string_literals;
  for (const auto& text : {"600 A\0s/m"s, "600 A\0"s, "600 \0A"s, "600 A\n"s, "600 A\rs/m"s, "600 A\x7f"s})
    EXPECT_EQ(error_of(text, "A"), "a control character in the unit");
}

TEST(Units, RefusalPrintsNothingOfItsOwn) {
  testing::internal::CaptureStderr();
  error_of("3 kq", "kg");
  error_of("3 A", "kg");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Units, FormattedQuantityReadsBackAsTheSameValue) {
  constexpr unsigned seed = 20060215;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> exponent(-9.0, 6.0);
  const std::vector<std::pair<std::string, std::string>> units{{"s", "us"}, {"m", "mm"}, {"m/s", "m/min"},
                                                               {"N", "kN"}, {"1", "1"},  {"N s/m", "N s/m"}};
  for (int i = 0; i < 600; ++i) {
    const auto& [si, unit] = units[static_cast<std::size_t>(i) % units.size()];
    const double value = std::pow(10.0, exponent(random));
    const std::string text = format_quantity(value, si, unit);
    // Fifteen digits are written: half a unit of the last one.
    EXPECT_NEAR(parse_quantity(text, si), value, 5e-15 * value) << text << ", seed " << seed;
  }
}

TEST(Units, FormatUsesTheGivenUnit) {
  EXPECT_EQ(format_quantity(62.5e-6, "s", "us"), "62.5 us");
  EXPECT_EQ(format_quantity(16.0 / 60.0, "m/s", "m/min"), "16 m/min");
  EXPECT_EQ(unit_of("600 A s/m"), "A s/m");
  EXPECT_EQ(unit_of("0.7"), "");
  EXPECT_EQ(unit_of("fast"), "");
}

}  // namespace
}  // namespace stiction::machine
