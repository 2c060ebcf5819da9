#include "host/diagnose/judge/holdout.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "host/algebra/least_squares.hpp"
#include "host/diagnose/classes/candidate_columns.hpp"
#include "host/diagnose/record/inverse_dynamics.hpp"
#include "host/identify/regression.hpp"

namespace stiction::host {
namespace {

struct Rows {
  Eigen::Index begin, length;
};

std::vector<Rows> records_of(const LogRows& rows) {
  std::vector<Rows> records;
  for (std::size_t k = 0; k < rows.logs().size(); ++k) {
    const auto begin = static_cast<Eigen::Index>(rows.logs()[k]);
    const auto end = static_cast<Eigen::Index>(rows.end(k));
    records.push_back({begin, end - begin});
  }
  return records;
}

// Takes the nuisances of each record out of a column of all rows.
class Nuisances {
 public:
  Nuisances(const LogRows& rows, const SearchContext& context, bool constant, bool coulomb) {
    std::vector<Eigen::VectorXd> columns;
    if (constant) columns.push_back(Eigen::VectorXd::Ones(rows.rows()));
    if (coulomb) columns.push_back(rows.stacked([&](const Motion& m) { return contact_level(context.axis, m); }));
    for (const auto& r : records_of(rows)) {
      Eigen::MatrixXd own(r.length, static_cast<Eigen::Index>(columns.size()));
      for (std::size_t c = 0; c < columns.size(); ++c)
        own.col(static_cast<Eigen::Index>(c)) = columns[c].segment(r.begin, r.length);
      records_.push_back(r);
      columns_.push_back(own);
      if (own.cols() > 0) solvers_.emplace_back(own);
    }
  }

  Eigen::VectorXd without(Eigen::VectorXd column) const {
    if (solvers_.empty()) return column;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const Eigen::VectorXd part = column.segment(records_[k].begin, records_[k].length);
      column.segment(records_[k].begin, records_[k].length) -= columns_[k] * solvers_[k].solve(part);
    }
    return column;
  }

 private:
  std::vector<Rows> records_;
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<PivotedLeastSquares> solvers_;
};

// A term's force in the rows; of a periodic one with the phase that fits each record best.
Eigen::VectorXd force_of_term(const LogRows& rows, const SearchContext& context, const Term& term,
                              const Eigen::VectorXd& target) {
  const auto& candidate = candidates()[term.candidate];
  const auto columns = shared_columns(rows, context, candidate, term.shape);
  // The training records' phases are not those of these.
  const Eigen::VectorXd coefficients =
      candidate.per_record
          ? Eigen::VectorXd(Eigen::Map<const Eigen::Vector2d>(effects::first_wave(term.coefficients).data()))
          : term.coefficients;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(rows.rows());
  if (!candidate.periodic) {
    for (std::size_t c = 0; c < columns.size(); ++c) force += coefficients[static_cast<Eigen::Index>(c)] * columns[c];
    return force;
  }
  constexpr int phases = 72;
  for (const auto& r : records_of(rows)) {
    double least = 0.0;
    for (int p = 0; p < phases; ++p) {
      Eigen::VectorXd part = Eigen::VectorXd::Zero(r.length);
      for (std::size_t c = 0; c + 1 < columns.size(); c += 2) {
        const auto i = static_cast<Eigen::Index>(c);
        const double harmonic = static_cast<double>(c / 2 + 1);
        const auto turned = std::complex(coefficients[i], coefficients[i + 1]) *
                            std::polar(1.0, 2.0 * std::numbers::pi * harmonic * p / phases);
        part += turned.real() * columns[c].segment(r.begin, r.length) +
                turned.imag() * columns[c + 1].segment(r.begin, r.length);
      }
      const double left = (target.segment(r.begin, r.length) - part).squaredNorm();
      if (p > 0 && left >= least) continue;
      least = left;
      force.segment(r.begin, r.length) = part;
    }
  }
  return force;
}

// The effects of the terms that runs describe, but for the one at `left_out`.
std::vector<machine::Effect> effects_in_runs(std::span<const Term> terms, std::size_t left_out) {
  std::vector<machine::Effect> effects;
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (k != left_out && terms[k].in_runs) effects.push_back(terms[k].in_runs->effect);
  return effects;
}

// The forces of the terms that runs describe, each with the others in the machine; `rest` loses all of them.
void take_terms_in_runs(const LogRows& rows, std::span<EffectResponse> responses, std::span<const Term> terms,
                        std::vector<Eigen::VectorXd>& forces, Eigen::VectorXd& rest) {
  const auto first = std::find_if(terms.begin(), terms.end(), [](const Term& term) { return term.in_runs; });
  if (first == terms.end()) return;
  // One description has one response.
  auto& response = responses[first->in_runs->response];
  std::vector<std::vector<machine::Effect>> sets{effects_in_runs(terms, terms.size())};
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (terms[k].in_runs) sets.push_back(effects_in_runs(terms, k));
  response.foresee(rows.motions(), sets);
  const auto together = [&](const std::vector<machine::Effect>& effects) -> Eigen::VectorXd {
    if (effects.empty()) return Eigen::VectorXd::Zero(rows.rows());
    return rows.stacked([&](const Motion& motion) { return response.together(motion, effects); });
  };
  const Eigen::VectorXd all = together(sets.front());
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (terms[k].in_runs) forces[k] = all - together(effects_in_runs(terms, k));
  rest -= all;
}

// The terms' forces, which `rest` loses.
std::vector<Eigen::VectorXd> take_terms(const LogRows& rows, const SearchContext& context,
                                        std::span<EffectResponse> responses, std::span<const Term> terms,
                                        Eigen::VectorXd& rest) {
  std::vector<Eigen::VectorXd> forces(terms.size());
  take_terms_in_runs(rows, responses, terms, forces, rest);
  // Phases of ripples are found with all other terms in place.
  for (const bool periodic : {false, true})
    for (std::size_t k = 0; k < terms.size(); ++k) {
      if (terms[k].in_runs || candidates()[terms[k].candidate].periodic != periodic) continue;
      forces[k] = force_of_term(rows, context, terms[k], rest);
      rest -= forces[k];
    }
  return forces;
}

// What each record may have beside the terms: not what one of them names.
struct Beside {
  bool constant = true, coulomb = true;

  explicit Beside(std::span<const Term> terms) {
    for (const auto& term : terms) {
      constant = constant && !candidates()[term.candidate].names_constant;
      coulomb = coulomb && !candidates()[term.candidate].names_coulomb;
    }
  }
};

std::vector<RowBlock> blocks_of_rows(const LogRows& rows) {
  return blocks_of(rows.velocity, rows.logs(), static_cast<std::size_t>(rows.rows() / 60 + 1));
}

}  // namespace

std::array<double, 2> ratio_interval(const Eigen::VectorXd& after, const Eigen::VectorXd& before, const LogRows& rows,
                                     std::uint64_t seed) {
  const auto blocks = blocks_of_rows(rows);
  std::vector<std::pair<double, double>> squares;
  for (const auto& b : blocks) {
    const auto begin = static_cast<Eigen::Index>(b.begin), length = static_cast<Eigen::Index>(b.end - b.begin);
    squares.emplace_back(after.segment(begin, length).squaredNorm(), before.segment(begin, length).squaredNorm());
  }
  std::mt19937_64 random(seed);
  std::vector<double> ratios;
  for (int r = 0; r < 400; ++r) {
    double a = 0.0, b = 0.0;
    for (std::size_t k = 0; k < squares.size(); ++k) {
      const auto& drawn = squares[random() % squares.size()];
      a += drawn.first;
      b += drawn.second;
    }
    ratios.push_back(std::sqrt(a / b));
  }
  const auto interval = interval_95(std::move(ratios));
  return {interval.low, interval.high};
}

Eigen::VectorXd without_terms(const LogRows& rows, const Eigen::VectorXd& target, const SearchContext& context,
                              std::span<const Term> terms) {
  Eigen::VectorXd rest = target;
  take_terms(rows, context, {}, terms, rest);
  return rest;
}

double held_out_force(const HeldOutData& data, std::span<const Term> terms, const std::vector<bool>& counted) {
  Eigen::VectorXd rest = data.target;
  const auto forces = take_terms(data.rows, data.context, data.responses, terms, rest);
  for (std::size_t k = 0; k < terms.size(); ++k)
    if (!counted[k]) rest += forces[k];
  const Beside beside(terms);
  return rms(Nuisances(data.rows, data.context, beside.constant, beside.coulomb).without(rest));
}

HeldOutFigures evaluate_held_out(const HeldOutData& data, std::span<const Term> terms) {
  const auto& rows = data.rows;
  const auto& context = data.context;
  Eigen::VectorXd rest = data.target;
  const auto forces = take_terms(rows, context, data.responses, terms, rest);
  const auto [constant, coulomb] = Beside(terms);
  const Nuisances nuisances(rows, context, constant, coulomb);
  const Eigen::VectorXd baseline = nuisances.without(data.target), extended = nuisances.without(rest);
  HeldOutFigures figures{rms(baseline), rms(extended), {}, {}, {}};
  const Whitening whitening(extended, rows, Memory::of_spans);
  const auto blocks = blocks_of_rows(rows);
  const auto held_out_amplitude = [&](const Eigen::VectorXd& before, const Eigen::VectorXd& after) {
    const Eigen::VectorXd force = before - after;
    const auto as_is = repetition_of(force, before, rows.logs(), blocks);
    const auto white = repetition_of(whitening(force), whitening(before), rows.logs(), blocks);
    return white.against() > as_is.against() ? white : as_is;
  };
  const Eigen::ArrayXd position = rows.stacked([](const Motion& m) { return m.x; }).array();
  const Eigen::ArrayXd recorded =
      (position >= context.lowest_position && position <= context.highest_position).cast<double>();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto& candidate = candidates()[terms[k].candidate];
    const Nuisances own(rows, context, !candidate.names_constant && constant, !candidate.names_coulomb && coulomb);
    Eigen::VectorXd after = own.without(rest), before = own.without(rest + forces[k]);
    if (candidate.along_stroke) after.array() *= recorded, before.array() *= recorded;
    HoldoutGain gain;
    gain.force_rms_ratio = rms(after) / rms(before);
    gain.ci95 = ratio_interval(after, before, rows, data.seed + k);
    figures.gains.push_back(gain);
    figures.held_out_amplitudes.push_back(held_out_amplitude(before, after));
  }
  figures.together = held_out_amplitude(baseline, extended);
  return figures;
}

}  // namespace stiction::host
