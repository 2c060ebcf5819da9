// The results of a sweep whose chunks are all there: the columns of sweep.npz, and what is read from them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/sweep/run.hpp"
#include "sim/experiment/experiment_result.hpp"

namespace stiction::host {

// Writes sweep.npz to `place`: a column for each key of `spec`, varied or not, one for each figure of `plan`, "status"
// ("done", "failed"), "message" and "command". `rows`: of the specification; `files`: of all chunks. Throws
// std::runtime_error.
void write_table(const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan, const ChunkFiles& files,
                 const std::filesystem::path& place);

// What a key does to a figure by itself: the share of the figure's variance between its values, and the mean of the
// figure at each (of a key that is drawn: in groups of the rows by its value).
struct MainEffect {
  std::string key;  // its column
  double share = 0.0;
  std::vector<std::string> levels;
  std::vector<double> at, mean;  // `at`: the mean number of the level; NaN of a text
};

// What two keys do together beyond what each does by itself: the further share of variance between their combinations.
struct Interaction {
  std::string first, second;
  double share = 0.0;
};

struct FigureEffects {
  SweepFigure figure;
  std::uint64_t rows = 0;  // that gave it
  double mean = 0.0, deviation = 0.0, least = 0.0, most = 0.0;
  std::vector<MainEffect> main;           // the strongest first
  std::vector<Interaction> interactions;  // the strongest first, at most ten
};

struct ParetoPoint {
  std::uint64_t row = 0;
  double first = 0.0, second = 0.0;
};

// One choice of the design keys with its worst case over all other keys.
struct DesignChoice {
  std::vector<std::string> values;  // of the design keys
  double worst = 0.0;               // infinite where a run failed
  std::uint64_t row = 0;            // that is the worst
};
struct RobustChoice {
  std::vector<std::string> keys;
  std::vector<DesignChoice> choices;  // in the order of the rows
  std::size_t best = 0;               // of the choices
};

struct SweepSummary {
  std::uint64_t rows = 0, failed = 0;
  std::vector<std::pair<std::string, std::uint64_t>> failures;  // messages with their numbers, the most frequent first
  std::vector<FigureEffects> effects;
  std::vector<ParetoPoint> pareto;  // by the first figure
  std::uint64_t worst_row = 0;      // of the figure `worst`
  double worst_value = 0.0;         // NaN where no run gave it
  SweepFigure worst;
  std::string worst_command;
  std::vector<RobustChoice> robust;  // one, or none
};

// Rows above which effects and Pareto front are made of every n-th row, so that memory stays bounded.
inline constexpr std::uint64_t most_analysed_rows = 1'000'000;

// Of the finished sweep of `spec`; `rows`: its rows; `plan`: its figures; `files`: all its chunks. Throws
// std::runtime_error.
SweepSummary summarize(const SweepSpec& spec, const SweepRows& rows, const SweepPlan& plan, const ChunkFiles& files);

// Figures, charts and sentences of a `summary` of `spec`, whose figures are those of `plan`, for the page of results.
sim::ExperimentResult sweep_result(const SweepSpec& spec, const SweepPlan& plan, const SweepSummary& summary);

}  // namespace stiction::host
