// Commands as calls. What they answer is compared with the commands in tests/host/python and tests/host/c_api.
#include "host/requests/request.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "host/requests/run_options.hpp"
#include "host/requests/usage_error.hpp"

namespace stiction::host {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string cross_table = std::string(STICTION_SOURCE_DIR) + "/firmware/machine/shipped/mcfv5050ln.toml";

// The text with which `request` is refused.
std::string refusal(const Request& request) {
  try {
    answer(request);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Request, NamesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal({"simulate circel", cross_table}), HasSubstr("did you mean 'simulate circle'?"));
  Request request{"simulate circle", cross_table};
  request.options = {{"fed", "16 m/min"}};
  EXPECT_THAT(refusal(request), HasSubstr("simulate circle: found 'fed'; expected an option among: "));
  request.options = {{"feed", ""}};
  EXPECT_THAT(refusal(request), HasSubstr("--feed: found an empty value"));
}

TEST(Request, RefusesLogsWhereTheCommandHasNone) {
  EXPECT_THAT(refusal({"simulate circle", cross_table, {}, {"a.csv"}}), HasSubstr("found 1 logs; expected none"));
  EXPECT_THAT(refusal({"identify", cross_table}), HasSubstr("found no log; expected at least one"));
  Request tuning{"tune-friction", cross_table};
  tuning.keep_logs = true;
  EXPECT_THAT(refusal(tuning), HasSubstr("expected it of simulations alone"));
  tuning = {"tune-friction", cross_table, {}, {}, {{"no-pulse", "maybe"}}};
  EXPECT_THAT(refusal(tuning), HasSubstr("--no-pulse: found 'maybe'; expected true or false"));
}

TEST(Request, KeepsTheRunsInTheirOrder) {
  Request request{"simulate circle", cross_table};
  request.options = {{"friction", "lugre"}, {"feed", "48 m/min"}, {"direction", "both"}};
  request.keep_logs = true;
  const auto found = answer(request);
  ASSERT_EQ(found.logs.size(), 2u);
  EXPECT_EQ(found.logs[0].run, "lugre 48 m/min ccw");
  EXPECT_EQ(found.logs[1].run, "lugre 48 m/min cw");
  EXPECT_EQ(found.document["rows"].size(), 4u);
  const auto columns = columns_of(found.logs[0].log);
  EXPECT_EQ(columns.front().name, "t");
  for (const auto& column : columns) EXPECT_EQ(column.values->size(), found.logs[0].log.t.size()) << column.name;
}

TEST(Request, EndsWhereItsProgressThrows) {
  struct Enough {};
  Request request{"simulate circle", cross_table};
  request.options = {{"friction", "lugre"}, {"feed", "48 m/min, 48 m/min, 48 m/min, 48 m/min, 48 m/min, 48 m/min"}};
  std::atomic<int> told = 0;
  EXPECT_THROW(answer(request,
                      [&](std::string_view) {
                        ++told;
                        throw Enough();
                      }),
               Enough);
  // A run that had begun on each processor ends, and none begins after it.
  EXPECT_LE(told, static_cast<int>(std::thread::hardware_concurrency()));
}

TEST(Request, GivesTheForcesOfItsCallerToThePlants) {
  Request request{"simulate circle", cross_table};
  request.options = {{"friction", "lugre"}, {"feed", "48 m/min"}};
  const auto smooth = answer(request).document["rows"];
  std::atomic<int> asked = 0;
  request.forces = {{"Y", [&](const AxisState& state) {
                       ++asked;
                       return -200.0 * state.position;
                     }}};
  const auto sprung = answer(request).document["rows"];
  EXPECT_EQ(sprung[0], smooth[0]);
  EXPECT_NE(sprung[1], smooth[1]);
  EXPECT_GT(asked, 1000);
}

TEST(Request, RefusesForcesThatNoPlantCanHave) {
  Request request{"simulate circle", cross_table};
  request.options = {{"friction", "lugre"}, {"feed", "48 m/min"}};
  const auto none = [](const AxisState&) { return 0.0; };
  request.forces = {{"Z", none}};
  EXPECT_THAT(refusal(request), HasSubstr("effect: found 'Z'; expected an axis of mcfv5050ln: X, Y"));
  request.forces = {{"X", [](const AxisState&) { return std::nan(""); }}};
  EXPECT_THAT(refusal(request), HasSubstr("effect on axis X: found the force nan at 0.000000 s"));
  request = {"simulate break-away", cross_table};
  request.options = {{"friction", "lugre"}};
  request.forces = {{"X", none}};
  EXPECT_THAT(refusal(request), HasSubstr("which no run has asked for; expected an experiment with that axis"));
  request = {"tune-friction", cross_table};
  request.forces = {{"X", none}};
  EXPECT_THAT(refusal(request), HasSubstr("found effects; expected them of simulations alone"));
}

TEST(Request, HasTheOptionsOfEveryCommand) {
  for (const auto& command : request_commands())
    for (const auto& option : request_options(command))
      EXPECT_FALSE(option.empty() || option.front() == '-') << command;
  EXPECT_THAT(request_options("tune-friction"), ElementsAre("axis", "columns", "feed", "show", "no-pulse"));
}

TEST(Lists, AreSplitAtCommasWithoutBlanks) {
  EXPECT_THAT(split_list("a, b ,c"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(split_list("one"), ElementsAre("one"));
  EXPECT_THAT(split_list("a,,b"), ElementsAre("a", "", "b"));
  EXPECT_THAT(split_list("a,"), ElementsAre("a"));
  EXPECT_THAT(split_list(""), ElementsAre(""));
}

}  // namespace
}  // namespace stiction::host
