#include "tests/compensation/cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iterator>
#include <mutex>
#include <thread>

#include "host/simulate/circle.hpp"
#include "host/simulate/l_shape.hpp"

namespace stiction::compensation {
namespace {

using Tasks = std::vector<std::function<void()>>;

void run_all(const Tasks& tasks) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) tasks[i]();
  };
  std::vector<std::jthread> workers;
  for (unsigned k = 1; k < std::thread::hardware_concurrency(); ++k) workers.emplace_back(work);
  work();
}

machine::Machine changed(const TunedAxis& tuned, CompensationKind kind, const Change* change) {
  auto machine = with_compensation(tuned, kind);
  if (change != nullptr) change->apply(machine.axes[tuned.axis]);
  return machine;
}

void drive_row(Row& row, const TunedAxis& tuned, const Change* change, std::uint64_t seed) {
  const auto drive = [&](CompensationKind kind) {
    const auto machine = changed(tuned, kind, change);
    if (row.feed == 0.0) return drive_small_reversals(machine, tuned.axis, row.radius, seed);
    return drive_circle(machine, tuned.axis, row.feed, row.radius, seed);
  };
  row.off = drive(CompensationKind::off);
  row.friction = drive(CompensationKind::friction);
  row.learning = drive(CompensationKind::learning);
  if (row.with_pulse) row.pulse = drive(CompensationKind::pulse);
}

Row row_of(const Truth& truth, const TunedAxis& tuned, double feed, double radius, const Change* change) {
  Row row;
  row.truth = truth.name;
  row.change = change == nullptr ? "" : change->name;
  row.axis = tuned.axis == 0 ? 'X' : 'Y';
  row.feed = feed;
  row.radius = radius;
  row.held = truth.held;
  row.coulomb = tuned.tuning.friction.coulomb;
  return row;
}

LShapeRow l_shape_of(const Truth& truth, const TunedAxis& x, const TunedAxis& y) {
  LShapeRow row{truth.name, {}, {}, {}, {}, {}, {}};
  auto machine = x.machine;
  machine.axes[1] = y.machine.axes[1];
  const auto drive = [&](CompensationKind kind, double& same, double& opposite) {
    for (auto& axis : machine.axes) axis.friction_compensation->use = kind;
    const auto run = host::drive_l_shape(machine);
    same = run.same_error;
    opposite = run.opposite_error;
  };
  drive(CompensationKind::off, row.same_off, row.opposite_off);
  drive(CompensationKind::friction, row.same_friction, row.opposite_friction);
  drive(CompensationKind::learning, row.same_learning, row.opposite_learning);
  return row;
}

bool feasible(const machine::Machine& machine, double feed, double radius) {
  sim::CircleSettings settings;
  settings.feed = feed * metre_per_minute;
  settings.radius = radius;
  try {
    host::check_circle(machine, settings);
  } catch (const host::InfeasibleMotion&) {
    return false;
  }
  return true;
}

// Collects the rows of all tables and runs them together.
class Runner {
 public:
  Runner(Proof& proof, bool quick) : proof_(proof), quick_(quick) {
    for (const auto& truth : truths())
      if (!quick || truth.name == std::string("elements") || truth.name == std::string("LuGre"))
        truths_.push_back(&truth);
  }

  void run() {
    proof_.tuned.resize(2 * truths_.size());
    Tasks tasks;
    for (std::size_t k = 0; k < proof_.tuned.size(); ++k)
      tasks.push_back([this, k] { proof_.tuned[k] = tune(*truths_[k / 2], k % 2, !quick_); });
    run_all(tasks);
    for (std::size_t k = 0; k < proof_.tuned.size(); ++k) add_rows(k);
    proof_.l_shape.resize(truths_.size());
    for (std::size_t k = 0; k < truths_.size(); ++k)
      work_.push_back(
          [this, k] { proof_.l_shape[k] = l_shape_of(*truths_[k], proof_.tuned[2 * k], proof_.tuned[2 * k + 1]); });
    // The tables no longer grow, so that their rows stay where they are.
    for (const auto& prepare : rows_) work_.push_back(prepare);
    run_all(work_);
  }

 private:
  void add_rows(std::size_t k) {
    const auto& truth = *truths_[k / 2];
    const auto& tuned = proof_.tuned[k];
    for (const double feed : feeds) {
      auto row = row_of(truth, tuned, feed, 0.09, nullptr);
      row.with_pulse = !quick_;
      add(proof_.circles, row, k, nullptr);
    }
    const bool main = truth.name == std::string("elements") || truth.name == std::string("LuGre");
    if (!main) return;
    for (const auto& change : changes())
      for (const double feed : feeds)
        if (!quick_ || feed == 8.0 || feed == 48.0)
          add(proof_.changed, row_of(truth, tuned, feed, 0.09, &change), k, &change);
    for (const double amplitude : {5e-6, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6})
      add(proof_.small, row_of(truth, tuned, 0.0, amplitude, nullptr), k, nullptr);
    if (!quick_)
      for (const double radius : {0.01, 0.02, 0.045})
        for (const double feed : feeds) {
          if (feasible(tuned.machine, feed, radius))
            add(proof_.radii, row_of(truth, tuned, feed, radius, nullptr), k, nullptr);
          else
            ++proof_.refused;
        }
    add_standstill(truth, k);
  }

  void add(std::vector<Row>& table, const Row& row, std::size_t k, const Change* change) {
    table.push_back(row);
    rows_.push_back([this, &table, place = table.size() - 1, k, change] {
      drive_row(table[place], proof_.tuned[k], change, 1000 + place);
    });
  }

  void add_standstill(const Truth& truth, std::size_t k) {
    proof_.standstill.push_back({truth.name, k % 2 == 0 ? 'X' : 'Y', {}, {}, {}});
    rows_.push_back([this, place = proof_.standstill.size() - 1, k] {
      auto& row = proof_.standstill[place];
      const double seconds = quick_ ? 5.0 : 60.0;
      const auto stand = [&](CompensationKind kind) {
        return stand_still(with_compensation(proof_.tuned[k], kind), k % 2, seconds, 77);
      };
      row.off = stand(CompensationKind::off);
      row.friction = stand(CompensationKind::friction);
      row.learning = stand(CompensationKind::learning);
    });
  }

  Proof& proof_;
  bool quick_;
  std::vector<const Truth*> truths_;
  Tasks rows_, work_;
};

// Largest value of `of` over rows, with where it is.
template <class Of>
std::pair<double, std::string> largest(const std::vector<Row>& rows, Of&& of) {
  double worst = 0.0;
  std::string where = "-";
  for (const auto& row : rows) {
    if (!row.held) continue;
    const double value = of(row);
    if (value <= worst) continue;
    worst = value;
    where = fmt::format("{} {}", row.truth, row.axis);
    if (row.feed > 0.0) where += fmt::format(", {:g} m/min", row.feed);
    if (row.feed == 0.0 || row.radius != 0.09)
      where += fmt::format(", {:g} {}", row.radius * (row.feed > 0.0 ? 1e3 : 1e6), row.feed > 0.0 ? "mm" : "um");
    if (!row.change.empty()) where += ", " + row.change;
  }
  return {worst, where};
}

}  // namespace

Proof run_proof(bool quick) {
  Proof proof;
  Runner(proof, quick).run();
  return proof;
}

std::vector<Figure> figures(const Proof& p) {
  std::vector<Figure> list;
  const auto um = [&](const char* text, const std::vector<Row>& rows, Outcome Row::*of, double bound) {
    const auto [worst, where] = largest(rows, [&](const Row& r) { return (r.*of).error; });
    list.push_back(
        {text, fmt::format("{:.2f} um ({}); at most {:g}", worst * 1e6, where, bound * 1e6), worst <= bound});
  };
  const auto share = [&](const char* text, const std::vector<Row>& rows, Outcome Row::*of, double bound) {
    const auto [worst, where] = largest(rows, [&](const Row& r) { return (r.*of).error / r.off.error; });
    list.push_back(
        {text, fmt::format("{:.0f} % ({}); at most {:.0f} %", worst * 100.0, where, bound * 100.0), worst <= bound});
  };
  um("circle R 90 mm, 3.2 to 48 m/min: peak error with (b)", p.circles, &Row::friction, 2e-6);
  um("the same with (c) after 4 laps", p.circles, &Row::learning, 1e-6);
  share("the same with (b), share of off", p.circles, &Row::friction, 0.3);
  share("the same with (c), share of off", p.circles, &Row::learning, 0.3);
  // At 3.2 m/min 30 % of off are 0.5 um: the half increment that the position controller does not see.
  std::vector<Row> faster;
  std::copy_if(p.circles.begin(), p.circles.end(), std::back_inserter(faster),
               [](const Row& r) { return r.feed > 3.2; });
  share("from 8 m/min on with (b), share of off", faster, &Row::friction, 0.3);
  if (!p.circles.empty() && p.circles.front().with_pulse) {
    const auto others = [](const Row& r) { return r.feed == pulse_feed ? 0.0 : r.friction.error / r.pulse.error; };
    const auto [worst, where] = largest(p.circles, others);
    list.push_back({"(b) over the best (a), feeds at which (a) was not tuned",
                    fmt::format("{:.0f} % ({}); below 100 %", worst * 100.0, where), worst < 1.0});
  }
  if (!p.radii.empty()) {
    um("radii 10, 20, 45 mm with (b)", p.radii, &Row::friction, 2e-6);
    um("radii 10, 20, 45 mm with (c) after 4 laps", p.radii, &Row::learning, 1e-6);
    share("radii 10, 20, 45 mm with (b), share of off", p.radii, &Row::friction, 0.3);
  }
  share("friction, mass, delay off: with (b), share of off", p.changed, &Row::friction, 0.4);
  share("friction, mass, delay off: with (c), share of off", p.changed, &Row::learning, 0.4);
  um("small reversals, 5 to 200 um, with (b)", p.small, &Row::friction, 2e-6);
  um("small reversals, 5 to 200 um, with (c)", p.small, &Row::learning, 1e-6);
  // Where off is not above half an increment of the position controller the error is its hunting, which scatters.
  double worse = 0.0;
  std::string at = "-";
  for (const auto* rows : {&p.circles, &p.radii, &p.changed, &p.small}) {
    const auto [excess, place] =
        largest(*rows, [](const Row& r) { return std::max(r.friction.error, r.learning.error) - r.off.error; });
    if (excess > worse) worse = excess, at = place;
  }
  list.push_back({"worse than off, in any case",
                  fmt::format("{:.3f} um ({}); at most 0.05, the quantiser's scatter", worse * 1e6, at),
                  worse <= 0.05e-6});
  const auto [added, where] = largest(p.circles, [](const Row& r) {
    return (std::max(r.friction.current, r.learning.current) - r.off.current) / std::max(r.coulomb, 0.1);
  });
  list.push_back({"peak current added, over the Coulomb current", fmt::format("{:.2f} ({}); at most 1.3", added, where),
                  added <= 1.3});
  double creep = 0.0, swing = 0.0, more = 0.0;
  int changes = 0, changes_off = 0;
  for (const auto& row : p.standstill)
    for (const auto* with : {&row.friction, &row.learning}) {
      creep = std::max(creep, with->creep);
      swing = std::max(swing, with->peak_to_peak);
      more = std::max(more, with->peak_to_peak - row.off.peak_to_peak);
      changes = std::max(changes, with->changes_of_held_error);
      changes_off = std::max(changes_off, row.off.changes_of_held_error);
    }
  list.push_back({"standstill: creep of the mean position of a second",
                  fmt::format("{:.4f} um; at most one increment, 1 um", creep * 1e6), creep <= 1e-6});
  // A limit cycle would swing by an increment and change the quantised error in every slow tick or few.
  list.push_back({"standstill: swing in a second; changes of the quantised error (off)",
                  fmt::format("{:.3f} um, {:.3f} more than off; {} ({}); no limit cycle", swing * 1e6, more * 1e6,
                              changes, changes_off),
                  swing <= 0.5e-6 && more <= 0.05e-6 && changes <= changes_off + 2});
  double restart = 0.0;
  for (const auto& row : p.l_shape)
    if (row.truth != "rigid")
      restart = std::max({restart, row.same_friction, row.same_learning, row.opposite_friction, row.opposite_learning});
  list.push_back({"L-shape at 8 m/min: restarts in same and opposite direction",
                  fmt::format("{:.2f} um; at most 2", restart * 1e6), restart <= 2e-6});
  return list;
}

}  // namespace stiction::compensation
