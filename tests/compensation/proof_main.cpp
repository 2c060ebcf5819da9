// The proof of the friction compensation as tables: truth machines, identification from their logs, every case with the
// compensation off and with each law, and the figures over them.
// usage: compensation_proof [--quick]      status 1: a figure is missed
#include <fmt/format.h>

#include <cstdio>
#include <string_view>

#include "tests/compensation/cases.hpp"

namespace {

using namespace stiction;
using namespace stiction::compensation;

void print_tuned(const Proof& proof) {
  fmt::print("Tuned from logs: circles R 90 mm at 3.2, 16 and 48 m/min, encoder 2 nm and current {:g} A rms noise\n",
             current_noise);
  std::size_t k = 0;
  for (const auto& tuned : proof.tuned) {
    const auto& t = tuned.tuning.friction;
    const auto& truth = proof.circles[5 * k++].truth;
    fmt::print(
        "{:<17}{}: Coulomb {:.3f} A, damping {:.2f} ms, mass {:.1f} kg, residual {:.4f} of {:.3f} A rms; {} elements "
        "at",
        truth, tuned.axis == 0 ? 'X' : 'Y', t.coulomb, t.friction.contact_damping * 1e3, t.mass, t.residual_rms,
        t.current_rms, t.friction.distance.size());
    for (const double d : t.friction.distance) fmt::print(" {:.1f}", d * 1e6);
    fmt::print(" um\n");
    const double tick = tuned.machine.timing.fast_period;
    for (const auto& lap : tuned.tuning.laps)
      fmt::print("{:20}look-ahead {:.0f} us: {} ({:+.0f} +- {:.0f} us)\n", "", lap.look_ahead * 1e6,
                 lap.timing.verdict(tick), lap.timing.late * 1e6, lap.timing.standard_error * 1e6);
    if (const auto& best = tuned.tuning.pulse)
      fmt::print(
          "{:20}best pulse at {:g} m/min: {:.3f} mm/s after {:.2f} ms for {:.2f} ms, {:.2f} to {:.2f} um in {} "
          "evaluations\n",
          "", pulse_feed, best->pulse.amplitude * 1e3, best->pulse.delay * 1e3, best->pulse.duration * 1e3,
          best->error_off * 1e6, best->error * 1e6, best->evaluations);
  }
}

void print_rows(const char* title, const std::vector<Row>& rows) {
  if (rows.empty()) return;
  fmt::print("\n{}\n{:<17}{:>2} {:>7} {:>7} {:>7} {:>6} {:>6} {:>6}  {:>5} {:>5}  {:>6} {:>6} {:>6}  {}\n", title,
             "truth", "", "m/min", "mm, um", "off", "(a)", "(b)", "(c)", "(b)%", "(c)%", "I off", "(b)", "(c)",
             "changed");
  for (const auto& r : rows)
    fmt::print(
        "{:<17}{:>2} {:>7} {:>7g} {:>7.2f} {:>6} {:>6.2f} {:>6.2f}  {:>5.0f} {:>5.0f}  {:>6.2f} {:>6.2f} {:>6.2f}  "
        "{}{}\n",
        r.truth, r.axis, r.feed > 0.0 ? fmt::format("{:g}", r.feed) : "", r.radius * (r.feed > 0.0 ? 1e3 : 1e6),
        r.off.error * 1e6, r.with_pulse ? fmt::format("{:.2f}", r.pulse.error * 1e6) : "", r.friction.error * 1e6,
        r.learning.error * 1e6, 100.0 * r.friction.error / r.off.error, 100.0 * r.learning.error / r.off.error,
        r.off.current, r.friction.current, r.learning.current, r.change, r.learning.dropped ? " table dropped" : "");
}

void print_others(const Proof& proof) {
  fmt::print("\nStandstill, um: creep, largest swing in a second, changes of the quantised error\n");
  for (const auto& row : proof.standstill)
    for (const auto& [name, s] :
         {std::pair("off", &row.off), std::pair("(b)", &row.friction), std::pair("(c)", &row.learning)})
      fmt::print("{:<17}{:>2}  {}  {:.4f}  {:.4f}  {}\n", row.truth, row.axis, name, s->creep * 1e6,
                 s->peak_to_peak * 1e6, s->changes_of_held_error);
  fmt::print("\nL-shape at 8 m/min, restart in the same and in the opposite direction, um: off, (b), (c)\n");
  for (const auto& row : proof.l_shape)
    fmt::print("{:<17}  same {:.2f} {:.2f} {:.2f}   opposite {:.2f} {:.2f} {:.2f}\n", row.truth, row.same_off * 1e6,
               row.same_friction * 1e6, row.same_learning * 1e6, row.opposite_off * 1e6, row.opposite_friction * 1e6,
               row.opposite_learning * 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc == 2 && std::string_view(argv[1]) == "--quick";
  if (argc > 1 && !quick) {
    fmt::print(stderr, "usage: compensation_proof [--quick]\n");
    return 2;
  }
  const Proof proof = run_proof(quick);
  print_tuned(proof);
  print_rows("Peak error over one lap, um, R 90 mm; (c) after 4 laps; peak current, A", proof.circles);
  print_rows("Other radii", proof.radii);
  if (proof.refused > 0) fmt::print("{} circles refused: v^2/R beyond the axis' acceleration\n", proof.refused);
  print_rows("Friction, mass or delay changed after tuning", proof.changed);
  print_rows("Small reversals, amplitude in um", proof.small);
  print_others(proof);
  fmt::print("\nFigures\n");
  int missed = 0;
  for (const auto& figure : figures(proof)) {
    fmt::print("{:<66} {}  {}\n", figure.text, figure.value, figure.met ? "met" : "MISSED");
    missed += !figure.met;
  }
  return missed == 0 ? 0 : 1;
}
