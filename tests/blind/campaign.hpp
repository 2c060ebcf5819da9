// Many blind cases through a diagnosis, and what comes of them: who was named for whom, parameters, intervals, gains.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/diagnose/verdict/verdict.hpp"
#include "tests/blind/blind_case.hpp"

namespace stiction::blind {

using Judge = std::function<host::Verdict(const BlindCase&)>;

// What a case is there to show.
struct Kind {
  const char* name;  // on the command line
  const char* text;
  int effects;   // hidden ones, of the vocabulary
  bool outside;  // one outside of it
  bool slightly_off;
  double share;
  int weight;  // of 40 cases; 0: only by name
};
std::span<const Kind> kinds();

struct PlannedCase {
  const Kind* kind;
  CaseOrder order;
};
// `count` cases: every kind by its weight, the effects in turn; with `only` (a kind's name) all of that one. Throws
// std::out_of_range for an unknown kind.
std::vector<PlannedCase> plan(int count, std::uint64_t seed, const std::string& only = "");

struct ParameterScore {
  std::string effect, key;
  double error = 0.0;       // relative to the true value (ripple: to its amplitude; a place: to 100 mm)
  double of_change = 0.0;   // relative to what it is off the machine file's value; 0: the file has none
  bool interval = false;    // whether a standard error was given
  double deviations = 0.0;  // that the found value is off, in standard errors
};

struct Outcome {
  const Kind* kind = nullptr;
  CaseOrder order;
  std::vector<std::string> named;  // findings in their order
  bool first_right = false;        // the first names a hidden one, or one exactly like it
  bool first_aliased = false;      // or one that it says cannot be told from a hidden one
  bool exact_set = false;          // all hidden ones and no other (exact aliases count)
  int wrong = 0;                   // findings that are neither
  std::string signature;           // of what is unexplained; empty: none
  std::string why;                 // what the diagnosis says of a hidden one that it did not name
  std::vector<ParameterScore> parameters;
  double gain = 0.0, oracle_gain = 0.0;  // N^2, cut of the residual force's mean square, held out
  double judge_seconds = 0.0;
  std::string error;  // what the diagnosis threw
};

Outcome score(const PlannedCase& planned, const BlindCase& blind, const host::Verdict& verdict);

// On `threads` threads; `done` after each case, from any of them.
std::vector<Outcome> run(const machine::Machine& shipped, const std::vector<PlannedCase>& plan, const Judge& judge,
                         int threads, const std::function<void(std::size_t)>& done);

// The tables that --blind prints.
std::string report(const std::vector<Outcome>& outcomes);

}  // namespace stiction::blind
