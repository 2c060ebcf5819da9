// What is misspelt on the command line is told with the nearest right spelling, and nothing runs.
#include "tests/host/cli/program.hpp"

namespace stiction::test {
namespace {

TEST_F(Cli, NamesTheNearestCommandExperimentAndOption) {
  expect_refused("simulat", "command: found 'simulat'; expected one of simulate, compare");
  expect_refused("simulat", "did you mean 'simulate'? (see `stiction --help`)");
  expect_refused("simulate cirle --machine emps", "did you mean 'circle'? (see `stiction simulate --help`)");
  expect_refused("machine lst", "did you mean 'list'?");
  expect_refused("completion fish", "shell: found 'fish'; expected one of bash, zsh");
  // The unknown option before the required one that it was meant to be.
  expect_refused("simulate circle --machin emps",
                 "--machin: found an unknown option; expected an option of `stiction simulate circle`; did you mean "
                 "'--machine'?");
  expect_refused("--verson", "did you mean '--version'?");
  expect_refused("simulate circle machine emps", "found 'machine' after `stiction simulate circle`");
  expect_refused("simulate circle machine emps", "did you mean '--machine'?");
  expect_refused("simulate circle --machine emps here", "found 'here' after `stiction simulate circle`; expected no");
}

TEST_F(Cli, NamesTheNearestValueOfAnOption) {
  const std::string run = "simulate circle --machine mcfv5050ln ";
  expect_refused("simulate circle --machine mcfv505ln", "did you mean \"mcfv5050ln\"?");
  expect_refused(run + "--friction lurge", "did you mean 'lugre'?");
  expect_refused(run + "--signals fixd", "--signals: found 'fixd'; expected fixed or double; did you mean 'fixed'?");
  expect_refused(run + "--direction boht", "--direction: found 'boht'; expected cw, ccw or both; did you mean 'both'?");
  expect_refused(run + "--compensation feed_forward", "--compensation: found 'feed_forward'");
  expect_refused("simulate frequency-response --machine mcfv5050ln --axis x", "did you mean 'X'?");
  expect_refused("simulate frequency-response --machine mcfv5050ln --loop velocty", "did you mean 'velocity'?");
  expect_refused("compare --reference cirle --machine mcfv5050ln", "did you mean 'circle'?");
  expect_refused("simulate circle --machine emps --friction lugre",
                 "--friction: found 'lugre', of which an axis has no parameters");
  expect_refused("simulate frequency-response --machine emps --periods two",
                 "--periods: found 'two'; expected a whole number");
  expect_refused("diagnose run.csv --machine emps --seed -1", "--seed: found '-1'; expected a whole number from 0 to");
  expect_refused("simulate circle --machine emps --feed ''", "--feed: found an empty value");
}

TEST_F(Cli, NamesTheNearestKeyUnitAndEffectOfAMachine) {
  const std::string run = "simulate circle --machine mcfv5050ln --set ";
  expect_refused(run + "axis.X.mas='3 kg'", "did you mean \"mass\"?");
  expect_refused(run + "axis.x.mass='3 kg'", "did you mean \"X\"?");
  expect_refused(run + "axis.X.mass='3 kgg'", "(unknown unit \"kgg\"; did you mean \"kg\"?)");
  expect_refused(run + "axis.X.friction.use=lugr", "did you mean \"lugre\"?");
  expect_refused(run + "axis.X.motor.model=forc", "did you mean \"force\"?");
  expect_refused("simulate circle --machine mcfv5050ln --feed '16 m/mn'",
                 "--feed: found '16 m/mn' (unknown unit \"m/mn\"; did you mean \"m/min\"?)");
  expect_refused("simulate circle --machine " + machine_with("[axis.X.motor]",
                                                             "effect = [{name = \"force_riple\"}]\n"
                                                             "[axis.X.motor]"),
                 "did you mean \"force_ripple\"?");
}

TEST_F(Cli, ADecimalCommaIsNoListAndNoNumber) {
  expect_refused("simulate circle --machine mcfv5050ln --feed '8,5 m/min'",
                 "--feed: found '8,5 m/min' (a comma between digits); expected numbers with a decimal point");
  expect_refused("simulate circle --machine mcfv5050ln --feed '8,5 m/min, 16 m/min'", "(a comma between digits)");
  expect_refused("tune-friction --machine emps --show '8,5 m/min'", "--show: found '8,5 m/min'");
  expect_refused("simulate circle --machine mcfv5050ln --radius '62,5 mm'", "for a decimal comma");
  expect_refused("simulate circle --machine mcfv5050ln --set axis.X.mass='3,5 kg'", "for a decimal comma");
  expect_refused("simulate circle --machine " + machine_with("numerator_damping = 0.05", "numerator_damping = 0,05"),
                 "(a decimal comma; numbers have a decimal point, as in 8.5); expected a TOML file");
}

}  // namespace
}  // namespace stiction::test
