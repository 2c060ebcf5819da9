#include "firmware/machine/file/nearest_name.hpp"

#include <gtest/gtest.h>

namespace stiction::machine {
namespace {

const std::vector<std::string_view> experiments{"circle", "impact", "l-shape", "break-away", "frequency-response"};

TEST(NearestName, OneSlipIsUnderstood) {
  for (const char* slip : {"cirle", "circel", "cyrcle", "circlee", "Circle"})
    EXPECT_EQ(nearest_name(slip, experiments), "circle") << slip;
  EXPECT_EQ(nearest_name("break_away", experiments), "break-away");
  EXPECT_EQ(nearest_name("x", {"X", "Y"}), "X");
}

TEST(NearestName, AnAbbreviationIsUnderstoodWhereItFitsOneNameOnly) {
  EXPECT_EQ(nearest_name("freq", experiments), "frequency-response");
  EXPECT_EQ(nearest_name("static", {"static_short", "static_long"}), "");
}

TEST(NearestName, WhatIsFarFromAllNamesIsLeftAlone) {
  EXPECT_EQ(nearest_name("square", experiments), "");
  EXPECT_EQ(nearest_name("", experiments), "");
  EXPECT_EQ(nearest_name("Z", {"X", "Y"}), "") << "one letter says nothing of another";
  EXPECT_EQ(nearest_name(std::string(100000, 'a'), experiments), "");
}

TEST(NearestName, TheNearestOfSeveralIsTaken) {
  EXPECT_EQ(nearest_name("velocit", {"position", "velocity_gain", "velocity"}), "velocity");
}

TEST(NearestName, TheMessageEndsWithTheName) {
  EXPECT_EQ(did_you_mean("cirle", experiments), "; did you mean \"circle\"?");
  EXPECT_EQ(did_you_mean("square", experiments), "");
}

}  // namespace
}  // namespace stiction::machine
