// `stiction simulate EXPERIMENT`.
#include <fmt/format.h>

#include <memory>

#include "host/cli/choices.hpp"
#include "host/cli/circle_command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/errors.hpp"
#include "host/cli/frequency_response_command.hpp"
#include "host/cli/machine_options.hpp"
#include "host/cli/output.hpp"
#include "host/output/circle_output.hpp"

namespace stiction::host {
namespace {

struct CircleOptions {
  MachineOptions machine;
  std::string friction;
  std::string feed;
  std::string direction = "ccw";
  std::string radius;
  std::string signals = "fixed";
  CirclePlaces places;
  bool json = false;
};

void simulate_circle(const CircleOptions& options, const Invocation& invocation) {
  const auto plan = circle_plan(options.machine.load(options.machine.machine, "circle"),
                                {options.friction, options.feed, options.direction, options.radius, options.signals});
  auto places = options.places;
  places.command = invocation.command;
  const auto result = run_plan(plan, places);
  const auto json = circle_json(result, plan.machine);
  if (!options.places.out.empty())
    write_circle_folder(options.places.out, plan, result, json, invocation, options.machine.machine);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}", circle_text(result, plan.machine));
  if (!options.places.out.empty()) fmt::print("\nreport: {}/report.html\n", options.places.out);
  if (!options.places.log.empty()) fmt::print("\ntrace: {}\n", options.places.log);
}

}  // namespace

void add_simulate(CLI::App& program, const Invocation& invocation) {
  auto* simulate = program.add_subcommand("simulate", "run an experiment: the firmware controls the simulated machine");
  expect_subcommand(*simulate, "experiment");

  auto* circle = simulate->add_subcommand("circle",
                                          "circle of two axes with a jerk-limited start: peak errors, currents and ISO "
                                          "230-4 terms of one lap; on a machine "
                                          "with one axis, a sine with the amplitude and frequency of the circle");
  auto o = std::make_shared<CircleOptions>();
  o->machine.add_to(*circle, "shipped machine by name, or a machine file");
  o->machine.add_compensation_to(*circle);
  circle->add_option("--friction", o->friction, "friction model, list of models, or all [as in the machine file]")
      ->type_name("MODEL");
  circle
      ->add_option("--feed", o->feed,
                   "feed along the path, which is the highest speed of each axis, or a list of feeds [16 m/min, or "
                   "slower where an axis requires it]")
      ->type_name("\"NUMBER UNIT\"");
  circle->add_option("--direction", o->direction, "direction of the circle")
      ->check(one_of({"cw", "ccw", "both"}))
      ->capture_default_str();
  circle->add_option("--radius", o->radius, "radius, the amplitude of each axis [90 mm, or the largest that fits]")
      ->type_name("\"NUMBER UNIT\"");
  circle
      ->add_option("--signals", o->signals,
                   "fixed: the firmware in fixed point; double: the same laws in double precision")
      ->check(one_of({"fixed", "double"}))
      ->capture_default_str();
  add_output_file(*circle, "--log", o->places.log, "write every signal of the cascade in every tick (CSV)");
  add_out(*circle, o->places.out, "write report.html and result.json into this folder");
  circle->add_flag("--json", o->json, "print the result as JSON on standard output");
  circle->callback([o, &invocation] { simulate_circle(*o, invocation); });

  add_experiments(*simulate, invocation);
  add_replay(*simulate, invocation);
  add_commissioning(*simulate, invocation);
  add_cam_run(*simulate, invocation);
  add_frequency_response(*simulate, invocation);
}

}  // namespace stiction::host
