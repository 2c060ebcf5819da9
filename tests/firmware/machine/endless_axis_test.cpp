// Endless axes in machine files: the turn in counts of the encoder, exactly as the file's numbers make it.
#include <gtest/gtest.h>

#include <string>

#include "firmware/machine/file/exact_value.hpp"
#include "firmware/machine/file/machine_notes.hpp"
#include "firmware/machine/model/fraction.hpp"
#include "tests/firmware/machine/machine_text.hpp"
#include "tests/support/rotary_joint.hpp"

namespace stiction::machine {
namespace {

using test::error_of;
using test::read_text;
using test::replaced;
using test::small_machine;

// The joint without ends, its encoder of 10000 counts on the motor behind `ratio`.
std::string geared(const std::string& ratio, const std::string& modulo = "360 deg") {
  auto text = replaced(stiction::test::rotary_joint, "travel = \"360 deg\"", "modulo = \"" + modulo + "\"");
  text = replaced(text, "counts = 4096", "on = \"motor\"\ncounts = 10000");
  // The constant of the motor is one at its shaft: with any ratio it makes the same of the axis here.
  return replaced(text, "[axis.J.motor]", "[axis.J.transmission]\nratio = " + ratio + "\n[axis.J.motor]");
}

std::string turn_of(const std::string& text) {
  const auto counts = read_text(text).axes[0].modulo_counts;
  return counts ? text_of(*counts) : "none";
}

TEST(EndlessAxis, ATurnIsTheFractionThatTheFileGives) {
  EXPECT_EQ(turn_of(geared("\"355/113\"")), "3550000/113");
  EXPECT_EQ(turn_of(geared("\"710/226\"")), "3550000/113");
  EXPECT_EQ(turn_of(geared("3.25")), "32500");
  EXPECT_EQ(turn_of(geared("\"3.1415929\"")), "31415929/1000");
  EXPECT_EQ(turn_of(geared("3")), "30000");
  EXPECT_EQ(turn_of(geared("\"1/3\"")), "10000/3");
  const auto axis = read_text(geared("\"355/113\"")).axes[0];
  EXPECT_EQ(axis.transmission->exact_ratio, (Fraction{355, 113}));
  EXPECT_EQ(axis.transmission->ratio, 355.0 / 113.0);
  EXPECT_EQ(axis.exact_modulo, (Fraction{1, 1}));
}

TEST(EndlessAxis, APartOfATurnOrSeveralAreFractionsToo) {
  EXPECT_EQ(turn_of(geared("\"355/113\"", "120 deg")), "3550000/339");
  EXPECT_EQ(turn_of(geared("\"355/113\"", "2 rev")), "7100000/113");
  EXPECT_EQ(turn_of(geared("\"355/113\"", "1296000 arcsec")), "3550000/113");
  EXPECT_EQ(turn_of(geared("7", "5400 arcmin")), "17500");
}

TEST(EndlessAxis, AnEncoderOnTheLoadCountsWholeTurns) {
  const auto endless = replaced(stiction::test::rotary_joint, "travel = \"360 deg\"", "modulo = \"360 deg\"");
  EXPECT_EQ(turn_of(endless), "4096");
  EXPECT_EQ(turn_of(replaced(endless, "counts = 4096", "increment = \"0.1 arcsec\"")), "12960000");
  EXPECT_EQ(turn_of(replaced(endless, "counts = 4096", "increment = \"0 deg\"")), "none");
  const auto part = error_of(replaced(endless, "counts = 4096", "increment = \"7 arcsec\""));
  EXPECT_NE(part.find("185143 increments by encoder.increment, \"7 arcsec\" (line 16); expected a whole number"),
            std::string::npos)
      << part;
}

// Of a turn there is no exact number of radians: such an encoder is no error, and has no phase.
TEST(EndlessAxis, AnIncrementInRadiansCountsNoTurns) {
  const auto text = replaced(geared("\"355/113\""), "counts = 10000", "increment = \"1e-6 rad\"");
  const auto machine = read_text(text);
  EXPECT_FALSE(machine.axes[0].modulo_counts.has_value());
  const auto notes = machine_notes(machine);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("its phase is not counted"), std::string::npos);
}

TEST(EndlessAxis, ALinearAxisMayBeEndless) {
  EXPECT_EQ(turn_of(replaced(small_machine, "travel = \"250 mm\"", "modulo = \"1.2 m\"")), "24000000");
  EXPECT_EQ(turn_of(small_machine), "none");
}

TEST(EndlessAxis, WhatIsNotExactIsToldWithItsLimit) {
  const auto refused = [](const std::string& text, const std::string& found, const std::string& expected) {
    const auto error = error_of(text);
    EXPECT_NE(error.find(found), std::string::npos) << error;
    EXPECT_NE(error.find(expected), std::string::npos) << error;
  };
  refused(geared("3.14159265358979323"), "axis.J.transmission.ratio: found 3.14159265358979",
          "at most 15 digits or a fraction such as \"355/113\"");
  refused(geared("\"3550000000000000/1130000000000001\""), "transmission.ratio: found \"3550000000000000/",
          "no fraction of two whole numbers from 1 to 1000000000000000 (10^15)");
  refused(geared("\"355/0\""), "transmission.ratio: found \"355/0\"", "no fraction of two whole numbers");
  refused(geared("\"355/113\"", "6.283185307 rad"), "axis.J.modulo: found \"6.283185307 rad\"",
          "a turn has no exact number of radians");
  refused(geared("\"999999999999999/113\""), "axis.J.modulo: found \"360 deg\"",
          "a numerator of at most 2^62 in the counts of a turn");
}

// A rounded ratio is nothing to refuse where no turn is counted.
TEST(EndlessAxis, AnAxisWithEndsNeedsNoFraction) {
  const auto ends = replaced(geared("3.14159265358979323"), "modulo", "travel");
  const auto axis = read_text(ends).axes[0];
  EXPECT_FALSE(axis.transmission->exact_ratio.has_value());
  EXPECT_FALSE(axis.modulo_counts.has_value());
  EXPECT_EQ(axis.transmission->ratio, 3.14159265358979323);
}

TEST(EndlessAxis, NumbersOfFilesAreFractions) {
  const auto text = [](std::string_view number) {
    const auto value = exact_number(number);
    return value ? text_of(*value) : "none";
  };
  for (const auto& [number, fraction] : {std::pair{"3.25", "13/4"},
                                         {"+2", "2"},
                                         {"1e-3", "1/1000"},
                                         {"2.50E+2", "250"},
                                         {"10/4", "5/2"},
                                         {"0.000000000000001", "1/1000000000000000"},
                                         {"3.2500000000000000000000", "13/4"},
                                         {".5", "1/2"}})
    EXPECT_EQ(text(number), fraction) << number;
  for (const char* number : {"", ".", "-3", "0", "3/0", "0/3", "-1/2", "1/-2", "1/2/3", "1e99", "nan", "inf", "0x10",
                             "1 2", "1234567890123456789", "99999999999999999999", "1e-16"})
    EXPECT_EQ(text(number), "none") << number;
}

TEST(EndlessAxis, ProductsOfFractionsCancelBeforeTheyOverflow) {
  const Fraction large{std::int64_t{1} << 62, 3};
  EXPECT_EQ(product(large, {3, std::int64_t{1} << 62}), (Fraction{1, 1}));
  EXPECT_EQ(quotient(large, large), (Fraction{1, 1}));
  EXPECT_FALSE(product(large, {5, 1}).has_value());
}

}  // namespace
}  // namespace stiction::machine
