#include "sim/cam/stand/response.hpp"

#include <array>
#include <cmath>
#include <functional>

#include "sim/cam/hermite.hpp"
#include "sim/cam/stand/transfer_function.hpp"
#include "sim/number/complex.hpp"

namespace stiction::sim::cam {
namespace {

using State = std::array<double, 4>;
using Quintic = std::array<double, 6>;  // of the set-point over a step, in powers of the share of the step

// The part of a motion between two states.
struct Stretch {
  const Piece& piece;
  double begin, length;  // of the master, within the cycle
};

// Calls `visit` with every stretch of `settings.cycles` cycles, the master's place where it begins over all cycles, the
// slave's offset and whether the stretch is as long as the one before.
template <class Visit>
void for_each_stretch(const Motion& motion, const ResponseSettings& settings, const Visit& visit) {
  const auto& curve = motion.curve;
  const double rise = curve.derivative(curve.end(), 0, Side::left) - curve(curve.begin());
  for (int cycle = 0; cycle < settings.cycles; ++cycle)
    for (const Piece& piece : curve.pieces()) {
      const double time = piece.length() / settings.master_speed;
      const auto steps = static_cast<int>(std::max(1.0, std::ceil(time / settings.step - 1e-9)));
      const double length = piece.length() / steps;
      for (int k = 0; k < steps; ++k)
        visit(Stretch{piece, piece.begin + k * length, length}, cycle * curve.length(), cycle * rise, k > 0);
    }
}

// Position, speed and acceleration of the set-point over a share of the stretch, at its end `x`.
EndState state_at(const Stretch& stretch, double x, double offset) {
  const double l = stretch.length;
  return {stretch.piece.derivative(x, 0) + offset, stretch.piece.derivative(x, 1) * l,
          stretch.piece.derivative(x, 2) * l * l, 0.0};
}

// The transfer function in controllable form, x'''' = u - d3 x''' - .. in units of a time that makes d0 = 1.
class ExactStep {
 public:
  explicit ExactStep(const TransferFunction& g) {
    const auto& d = g.denominator;
    rate_ = std::sqrt(std::sqrt(d[0] / d[4]));
    double power = 1.0;
    for (std::size_t k = 0; k < 5; ++k, power *= rate_) {
      if (k < 4) denominator_[k] = d[k] * power / d[0];
      if (k < 3) numerator_[k] = g.numerator[k] * power / d[0];
    }
  }

  double rate() const { return rate_; }  // 1/s
  // d0..d3 of s^4 + d3 s^3 + .. in units of the rate.
  const State& denominator() const { return denominator_; }
  const std::array<double, 3>& numerator() const { return numerator_; }

  // From now on a step takes `time` s. Both matrices are sums of a series: with A the system's matrix, B its input and
  // h the step, the state goes with sum (A h)^j / j!, and t^k of the input adds sum A^j B h^(j+1) k! / (j + k + 1)!.
  void set_step(double time) {
    const double h = time * rate_;
    for (std::size_t i = 0; i < 4; ++i) {
      State column{};
      column[i] = 1.0;
      transition_[i] = series(column, h, 0);
    }
    const State input{0.0, 0.0, 0.0, 1.0};
    for (int k = 0; k < 6; ++k) {
      State sum = series(input, h, k + 1);
      for (double& value : sum) value *= h;
      from_input_[static_cast<std::size_t>(k)] = sum;
    }
  }

  State advance(const State& state, const Quintic& input) const {
    State next{};
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t row = 0; row < 4; ++row) next[row] += transition_[i][row] * state[i];
    for (std::size_t k = 0; k < 6; ++k)
      for (std::size_t row = 0; row < 4; ++row) next[row] += from_input_[k][row] * input[k];
    return next;
  }

  // Of the drive on the rotor, whose transfer function has the numerator (k_D + b_D s)(I_Z s^2 + b_H s + k_H). `input`,
  // `speed`: of the set-point, over time.
  double force(const ElasticDrive& drive, const State& x, double input, double speed) const {
    const auto& [inertia, rotor, stiffness, damping, k, b] = drive;
    const double unit = k * stiffness;
    const State n{1.0, (k * damping + b * stiffness) * rate_ / unit, (k * inertia + b * damping) * rate_ * rate_ / unit,
                  b * inertia * rate_ * rate_ * rate_ / unit};
    const double fourth =
        input - denominator_[0] * x[0] - denominator_[1] * x[1] - denominator_[2] * x[2] - denominator_[3] * x[3];
    const double position = n[0] * x[0] + n[1] * x[1] + n[2] * x[2] + n[3] * x[3];
    const double moves = (n[0] * x[1] + n[1] * x[2] + n[2] * x[3] + n[3] * fourth) * rate_;
    return k * (input - position) + b * (speed - moves);
  }

  // Of the load, with the set-point where it is.
  LoadState load(const State& x, double input, double master) const {
    const double fourth =
        input - denominator_[0] * x[0] - denominator_[1] * x[1] - denominator_[2] * x[2] - denominator_[3] * x[3];
    const auto& n = numerator_;
    return {master, n[0] * x[0] + n[1] * x[1] + n[2] * x[2], (n[0] * x[1] + n[1] * x[2] + n[2] * x[3]) * rate_,
            (n[0] * x[2] + n[1] * x[3] + n[2] * fourth) * rate_ * rate_};
  }

 private:
  State multiplied(const State& x) const {
    return {x[1], x[2], x[3],
            -denominator_[0] * x[0] - denominator_[1] * x[1] - denominator_[2] * x[2] - denominator_[3] * x[3]};
  }
  // The sum over j of (A h)^j x k'!/(j + order)!, k' = order - 1 (0: of order 0).
  State series(State x, double h, int order) const {
    State sum{};
    double factor = 1.0;
    // k'! / order! of the first term.
    if (order > 0) factor = 1.0 / order;
    constexpr int most_terms = 200;
    for (int j = 0; j < most_terms; ++j) {
      double size = 0.0, largest = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        sum[i] += factor * x[i];
        size = std::max(size, std::fabs(factor * x[i]));
        largest = std::max(largest, std::fabs(sum[i]));
      }
      if (j > 4 && size <= 1e-19 * largest) break;
      x = multiplied(x);
      factor *= h / (j + 1 + order);
    }
    return sum;
  }

  double rate_ = 1.0;
  State denominator_{};
  std::array<double, 3> numerator_{};
  std::array<State, 4> transition_{};  // columns
  std::array<State, 6> from_input_{};
};

// Runs over `motion` and calls `each(master, state, set-point, its speed)` at every state, the start included.
template <class Each>
void run_exactly(ExactStep& step, const Motion& motion, const ResponseSettings& settings, const Each& each) {
  const double start = motion.curve(motion.curve.begin());
  State state{};
  each(motion.curve.begin(), state, 0.0, motion.curve.derivative(motion.curve.begin(), 1) * settings.master_speed);
  for_each_stretch(motion, settings, [&](const Stretch& s, double cycles, double offset, bool same) {
    if (!same) step.set_step(s.length / settings.master_speed);
    const auto first = state_at(s, s.begin, offset - start), last = state_at(s, s.begin + s.length, offset - start);
    const auto coefficients = quintic(first, last);
    Quintic input;
    std::copy(coefficients.begin(), coefficients.end(), input.begin());
    state = step.advance(state, input);
    each(s.begin + s.length + cycles, state, last.position, last.speed / s.length * settings.master_speed);
  });
}

// Of the rotor: whether it sticks, and friction on it while it slips.
struct Contact {
  double coulomb = 0.0;  // 0: no friction
  bool sticks = false;
  double direction = 0.0;  // of the rotor's speed
};

// Drive and shaft on the rotor.
double force_on_rotor(const ElasticDrive& d, const State& q, double u, double speed) {
  return d.drive_stiffness * (u - q[2]) + d.drive_damping * (speed - q[3]) - d.shaft_stiffness * (q[2] - q[0]) -
         d.shaft_damping * (q[3] - q[1]);
}

// (y, y', x, x') of load and rotor.
State lagrange_rate(const ElasticDrive& d, const State& q, double u, double speed, const Contact& contact) {
  const double shaft = d.shaft_stiffness * (q[2] - q[0]) + d.shaft_damping * (q[3] - q[1]);
  const double rotor = contact.sticks ? 0.0 : force_on_rotor(d, q, u, speed) - contact.coulomb * contact.direction;
  return {q[1], shaft / d.load_inertia, contact.sticks ? 0.0 : q[3], rotor / d.rotor_inertia};
}

// What the rotor does from here on: it sticks at rest where friction holds it.
void find_contact(const ElasticDrive& d, State& q, double u, double speed, Contact& contact) {
  if (contact.coulomb == 0.0) return;
  const bool turned = !contact.sticks && q[3] * contact.direction <= 0.0;
  if (!turned && !contact.sticks) return;
  q[3] = 0.0;
  const double force = force_on_rotor(d, q, u, speed);
  contact.sticks = std::fabs(force) <= contact.coulomb;
  contact.direction = contact.sticks ? 0.0 : std::copysign(1.0, force);
}

State moved(const State& q, const State& rate, double time) {
  State next = q;
  for (std::size_t i = 0; i < 4; ++i) next[i] += time * rate[i];
  return next;
}

}  // namespace

std::vector<LoadState> transfer_response(const ElasticDrive& drive, const Motion& motion,
                                         const ResponseSettings& settings) {
  ExactStep step(transfer_function(drive));
  const double start = motion.curve(motion.curve.begin());
  std::vector<LoadState> states;
  run_exactly(step, motion, settings, [&](double master, const State& x, double input, double) {
    states.push_back(step.load(x, input, master));
    states.back().position += start;
  });
  return states;
}

std::vector<double> transfer_forces(const ElasticDrive& drive, const Motion& motion, const ResponseSettings& settings) {
  ExactStep step(transfer_function(drive));
  std::vector<double> forces;
  run_exactly(step, motion, settings, [&](double, const State& x, double input, double speed) {
    forces.push_back(step.force(drive, x, input, speed));
  });
  return forces;
}

std::vector<LoadState> lagrange_response(const ElasticDrive& drive, const Motion& motion,
                                         const ResponseSettings& settings, double coulomb) {
  const double start = motion.curve(motion.curve.begin()), w = settings.master_speed;
  State q{start, 0.0, start, 0.0};
  Contact contact{coulomb, coulomb > 0.0, 0.0};
  const auto seen = [&](double master, double u, double speed) {
    return LoadState{master, q[0], q[1], lagrange_rate(drive, q, u, speed, contact)[1]};
  };
  std::vector<LoadState> states{seen(motion.curve.begin(), start, 0.0)};
  // At most 20 us a step: half of it moves the load by 2e-8 degrees of 30.
  constexpr double longest = 20e-6;
  for_each_stretch(motion, settings, [&](const Stretch& s, double cycles, double offset, bool) {
    const double time = s.length / w;
    const auto steps = static_cast<int>(std::max(1.0, std::ceil(time / longest - 1e-9)));
    const double h = time / steps;
    const auto at = [&](double k) {
      const double x = s.begin + s.length * k / steps;
      return std::array{s.piece.derivative(x, 0) + offset, s.piece.derivative(x, 1) * w};
    };
    for (int k = 0; k < steps; ++k) {
      const auto begin = at(k), middle = at(k + 0.5), end = at(k + 1.0);
      find_contact(drive, q, begin[0], begin[1], contact);
      const State a = lagrange_rate(drive, q, begin[0], begin[1], contact);
      const State b = lagrange_rate(drive, moved(q, a, 0.5 * h), middle[0], middle[1], contact);
      const State c = lagrange_rate(drive, moved(q, b, 0.5 * h), middle[0], middle[1], contact);
      const State d = lagrange_rate(drive, moved(q, c, h), end[0], end[1], contact);
      for (std::size_t i = 0; i < 4; ++i) q[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
    const auto last = at(steps);
    states.push_back(seen(s.begin + s.length + cycles, last[0], last[1]));
  });
  return states;
}

std::complex<double> modal_residual(const ElasticDrive& drive, const Motion& motion, double master_speed, double at) {
  ExactStep step(transfer_function(drive));
  const auto& d = step.denominator();
  const auto& n = step.numerator();
  const Mode mode = load_mode(drive);
  const std::complex<double> p = mode.pole / step.rate();
  // Left and right vectors of the pole in controllable form.
  const std::array<std::complex<double>, 4> left{((p + d[3]) * p + d[2]) * p + d[1], (p + d[3]) * p + d[2], p + d[3],
                                                 1.0};
  const std::complex<double> across = left[0] + left[1] * p + left[2] * p * p + left[3] * p * p * p;
  std::complex<double> found = 0.0;
  double reached = 0.0;
  const ResponseSettings settings{.master_speed = master_speed};
  bool done = false;
  run_exactly(step, motion, settings, [&](double master, const State& x, double input, double) {
    if (done) return;
    const std::complex<double> along = left[0] * (x[0] - input) + left[1] * x[1] + left[2] * x[2] + left[3] * x[3];
    found = (n[0] + n[1] * p + n[2] * p * p) * quotient(along, across);
    reached = master;
    done = master >= at - 1e-12 * motion.curve.length();
  });
  // The last state may lie a little behind the place; the mode runs back to it.
  return found * sim::exponential(mode.pole * ((at - reached) / master_speed));
}

}  // namespace stiction::sim::cam
