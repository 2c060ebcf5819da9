#include "sim/cam/shaping/number_search.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "sim/cam/shaping/lift.hpp"
#include "sim/cam/shaping/normal_equations.hpp"

namespace stiction::sim::cam {
namespace {

using Complex = std::complex<double>;
using Place = std::array<double, 2>;

// Thrown within a search where a cycle has not been run yet.
struct NotYetRun {};

class Trials {
 public:
  explicit Trials(const CycleQuality& quality) : quality_(quality) {}

  // The number of a cycle with `cam`.
  double at(const Place& place, const Cam& cam) {
    const auto found = quality_(cam);
    if (!found) {
      result_.next = cam;
      throw NotYetRun();
    }
    result_.trials.push_back({place, *found});
    if (result_.trials.size() == 1 || *found < result_.least.quality)
      result_.least = result_.trials.back(), result_.best = cam;
    return *found;
  }
  // What a search found, and how far it came.
  template <class Search>
  NumberSearch of(const Search& search) {
    try {
      search();
    } catch (const NotYetRun&) {
    }
    return std::move(result_);
  }

 private:
  const CycleQuality& quality_;
  NumberSearch result_;
};

Cam with_pair(const ShapingTask& task, const PulsePair& pair) {
  return with_lift(task.motion.cam, with_pulses(task, pair));
}

// Three trials about the untuned one: what they cancel by the model of the machine file, on a circle. Four cycles
// determine a form whose level lines are circles; the next ones are each at the minimum of the ones before, where the
// form has to hold.
constexpr int on_circle = 3, at_minimum = 3;
Complex on_unit_circle(int k) { return std::polar(1.0, 2.0 * std::numbers::pi * k / on_circle); }

// The vibration at the end of the rise whose area over the whole dwell is `quality`. An area that begins later makes
// the circle smaller, which keeps the trials further from the limits.
double size_of(const ShapingTask& task, double quality) {
  const double decay = -task.mode().pole.real();
  const double time = (std::min(task.dwell.end(), task.motion.curve.length()) - task.end()) / task.master_speed;
  const double lasting = decay * time > 1e-9 ? (1.0 - std::exp(-decay * time)) / decay : time;
  // The mean of the magnitude of a sine is 2/pi.
  return quality / (2.0 * 2.0 / std::numbers::pi * lasting * task.master_speed);
}

// Places at which no trial breaks a limit, and the largest circle for it.
struct Circle {
  PulsePlaces places;
  double size = 0.0;
};
Circle circle_for(const ShapingTask& task, const TunerSettings& settings, double size) {
  Circle best;
  double least = std::numeric_limits<double>::infinity();
  const double own = settings.share_of_limits ? settings.share_of_limits(task.motion, 0.0) : 0.0;
  for (const auto& places : pulse_places()) {
    double share = 0.0;
    for (int k = 0; k < on_circle; ++k) {
      const auto pair = pulse_pair(task, size * on_unit_circle(k), places);
      if (!pair) {
        share = std::numeric_limits<double>::infinity();
        break;
      }
      if (settings.share_of_limits)
        share = std::max(share, settings.share_of_limits(compose(with_pair(task, *pair)), 0.0));
    }
    if (share >= least) continue;
    // What the pulses add goes with the circle.
    const double room = share > usable_share ? (usable_share - own) / (share - own) : 1.0;
    best = {places, size * std::max(0.2, room)};
    least = share;
    if (room == 1.0) return best;
  }
  return best;
}

// A trial: what it cancels, and its number over the untuned one.
struct Evaluated {
  Complex cancelled;
  double number;
};

// The form of the numbers: each is the length of the vector L^T (z - minimum), L a lower triangle, since two pulses do
// to the vibration what a linear map does, and at the minimum nothing is left of it.
struct Form {
  double x, y, l11, l21, l22;

  double number(Complex z) const { return std::hypot(along(z), across(z)); }
  double along(Complex z) const { return l11 * (z.real() - x) + l21 * (z.imag() - y); }
  double across(Complex z) const { return l22 * (z.imag() - y); }
};

// A number is an area of a few half-waves, which goes with their phase beside what the form has, and ends in the noise
// of the encoder: it is known to this share of itself and to that of the untuned one, so that trials near the minimum
// count most.
double error_of(double number) {
  constexpr double of_itself = 0.02, of_untuned = 0.003;
  return std::hypot(of_itself * number, of_untuned);
}

// By weighted least squares (Gauss, Newton and Marquardt). Where trials are fewer than coefficients, the map is the
// nearest to a similarity: for a frequency that is a fifth off its two lengths differ by a third or less.
std::optional<Form> fitted_form(const std::vector<Evaluated>& trials, Form form) {
  constexpr double from_similarity = 0.3;
  constexpr int most_iterations = 60;
  const auto sum_of = [&](const Form& f) {
    const double size = std::max(std::fabs(f.l11), std::fabs(f.l22)) * from_similarity;
    double sum = std::pow((f.l11 - f.l22) / size, 2.0) + std::pow(f.l21 / size, 2.0);
    for (const auto& [z, number] : trials) sum += std::pow((f.number(z) - number) / error_of(number), 2.0);
    return sum;
  };
  double least = sum_of(form), damping = 1e-3;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Normal<5> normal;
    for (const auto& [z, number] : trials) {
      const double found = std::max(1e-9, form.number(z)), weight = 1.0 / (found * error_of(number));
      const double a = form.along(z), c = form.across(z), x = z.real() - form.x, y = z.imag() - form.y;
      normal.add({-a * form.l11 * weight, -(a * form.l21 + c * form.l22) * weight, a * x * weight, a * y * weight,
                  c * y * weight},
                 (number - found) / error_of(number));
    }
    const double size = std::max(std::fabs(form.l11), std::fabs(form.l22)) * from_similarity;
    normal.add({0.0, 0.0, 1.0 / size, 0.0, -1.0 / size}, (form.l22 - form.l11) / size);
    normal.add({0.0, 0.0, 0.0, 1.0 / size, 0.0}, -form.l21 / size);
    for (std::size_t k = 0; k < 5; ++k) normal.matrix[k][k] *= 1.0 + damping;
    const auto step = normal.solve();
    const Form next{form.x + step[0], form.y + step[1], form.l11 + step[2], form.l21 + step[3], form.l22 + step[4]};
    const double sum = sum_of(next);
    if (!(sum < least)) {
      damping *= 8.0;
      if (damping > 1e9) break;
      continue;
    }
    const double gain = least - sum;
    form = next;
    least = sum;
    damping *= 0.2;
    if (gain < 1e-9 * least) break;
  }
  return std::isfinite(form.x + form.y) ? std::optional(form) : std::nullopt;
}

// From four trials or more: of circles about several places the best one, and from there.
std::optional<Form> form_of(const std::vector<Evaluated>& trials) {
  std::optional<Form> best;
  double least = std::numeric_limits<double>::infinity();
  constexpr int starts = 8;
  for (int k = 0; k < starts; ++k) {
    const Complex at = std::polar(1.0, 2.0 * std::numbers::pi * k / starts);
    const auto form = fitted_form(trials, {at.real(), at.imag(), 1.0, 0.0, 1.0});
    if (!form) continue;
    double sum = std::pow((form->l11 - form->l22) / form->l11, 2.0) + std::pow(form->l21 / form->l11, 2.0);
    for (const auto& [z, number] : trials) sum += std::pow((form->number(z) - number) / error_of(number), 2.0);
    if (sum < least) least = sum, best = form;
  }
  return best;
}

Cam with_one(const ShapingTask& task, double length, Place at) {
  at[0] = std::clamp(at[0], task.begin, task.end() - length);
  return with_lift(task.motion.cam, with_pulse(task, {at[0], at[1]}, "polynomial_3_4_5", length));
}

Place between(const Place& a, const Place& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
}

using Vertices = std::array<SearchTrial, 3>;

void sort(Vertices& vertices) {
  std::sort(vertices.begin(), vertices.end(),
            [](const SearchTrial& a, const SearchTrial& b) { return a.quality < b.quality; });
}

// Reflection 1, expansion 2, contraction and reduction 1/2 (Nelder, Mead 1965).
template <class Tried>
void one_step(Vertices& vertices, const Tried& tried) {
  sort(vertices);
  SearchTrial& worst = vertices[2];
  const Place middle = between(vertices[0].at, vertices[1].at, 0.5), from = worst.at;
  const auto beyond = [&](double share) { return tried(between(middle, from, share)); };
  const SearchTrial reflected = beyond(-1.0);
  if (reflected.quality < vertices[0].quality) {
    const SearchTrial expanded = beyond(-2.0);
    worst = expanded.quality < reflected.quality ? expanded : reflected;
  } else if (reflected.quality < vertices[1].quality) {
    worst = reflected;
  } else {
    const SearchTrial contracted = beyond(reflected.quality < worst.quality ? -0.5 : 0.5);
    if (contracted.quality < std::min(worst.quality, reflected.quality))
      worst = contracted;
    else
      for (std::size_t k = 1; k < 3; ++k) vertices[k] = tried(between(vertices[0].at, vertices[k].at, 0.5));
  }
  sort(vertices);
}

}  // namespace

NumberSearch search_by_quadratic_form(const ShapingTask& task, const TunerSettings& settings,
                                      const CycleQuality& quality) {
  Trials trials(quality);
  std::optional<PulsePair> where;
  auto found = trials.of([&] {
    const double untuned = trials.at({0.0, 0.0}, task.motion.cam);
    const auto [places, size] = circle_for(task, settings, size_of(task, untuned));
    std::vector<Evaluated> evaluated{{0.0, 1.0}};
    const auto run = [&, &at = places, &of = size](Complex cancelled) {
      const auto pair = pulse_pair(task, of * cancelled, at);
      if (!pair) throw CamError("found no room for two pulses in the rise; expected 0.75 periods of the load or more");
      where = pair;
      const double number = trials.at({pair->first.amplitude, pair->second.amplitude}, with_pair(task, *pair));
      evaluated.push_back({cancelled, number / untuned});
    };
    for (int k = 0; k < on_circle; ++k) run(on_unit_circle(k));
    for (int k = 0; k < at_minimum; ++k) {
      const auto form = form_of(evaluated);
      // Without a form the best trial is what there is.
      if (!form) return;
      run({form->x, form->y});
    }
  });
  found.where = where;
  return found;
}

NumberSearch search_by_simplex(const ShapingTask& task, double length, const Simplex& start, int steps,
                               const CycleQuality& quality) {
  Trials trials(quality);
  return trials.of([&] {
    const auto tried = [&](const Place& at) { return SearchTrial{at, trials.at(at, with_one(task, length, at))}; };
    Vertices vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) vertices[k] = tried(start[k]);
    for (int step = 0; step < steps; ++step) one_step(vertices, tried);
  });
}

Simplex first_simplex(const ShapingTask& task, double length) {
  const double last = task.end() - length, period = task.period_length();
  const double height = -0.02 * task.stroke;
  return {{{last - 0.2 * period, height}, {last - 0.4 * period, height}, {last - 0.3 * period, 2.0 * height}}};
}

NumberSearch search_by_halving(const ShapingTask& task, double length, int sweeps, const CycleQuality& quality) {
  Trials trials(quality);
  return trials.of([&] {
    constexpr int halvings = 5;
    const double last = task.end() - length, half = 0.5 * task.period_length();
    Place at{last - 0.5 * half, 0.0};
    std::array<double, 2> width{half, 0.1 * std::fabs(task.stroke)};
    trials.at(at, with_one(task, length, at));
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        double whole = width[axis];
        for (int k = 0; k < halvings; ++k, whole *= 0.5) {
          Place low = at, high = at;
          low[axis] -= 0.25 * whole;
          high[axis] += 0.25 * whole;
          const double at_low = trials.at(low, with_one(task, length, low));
          const double at_high = trials.at(high, with_one(task, length, high));
          at = at_low < at_high ? low : high;
        }
        width[axis] *= 0.5;
      }
  });
}

}  // namespace stiction::sim::cam
