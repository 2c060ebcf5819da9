// What logs tell of the axis that a machine file is made of: answers to questions of the sheet (questions.hpp), each
// with the log that it is from, and what is left open with the record that would determine it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/log/log.hpp"
#include "host/sheet/log_marks.hpp"
#include "host/sheet/questions.hpp"

namespace stiction::host {

// An answer of the logs, in SI units of the axis; amperes are amplitudes.
struct LogFact {
  std::string answer;            // as a sheet would give it: "0.2464 m"
  std::string source;            // "the log emps.csv"
  std::string detail;            // "the smallest step of x"
  double value = 0.0;            // of a quantity
  double low = 0.0, high = 0.0;  // outside of which a sheet's value contradicts it, in the unit of `value`

  std::string comment() const { return "from " + source + ": " + detail; }
};

struct LogFacts {
  std::string names;   // of the files: "emps.csv"
  std::string source;  // "the log emps.csv", "the logs a.csv, b.csv"
  bool rotary = false;
  std::map<std::string, LogFact, std::less<>> facts;     // by question
  std::map<std::string, std::string, std::less<>> open;  // by question: why it is not filled, and what to record
  double increment = 0.0;                                // m or rad, the smallest step of the position; 0: none seen
  double effort_volts = 0.0, effort_amperes = 0.0;       // the largest of the logs; 0: no such column
  bool has_force = false;                                // a column of the motor's force or torque
  LogMarks marks;                                        // those that no answer has
};

// What `logs` show by themselves: kind and name of the axis, increment, period, ways reached, limits at which samples
// stand. `logs`: at least one, with each stretch of a record; `axis`: of them that the file is made of, empty where
// they have one alone. Throws LogError for logs of several axes and no `axis`, and for logs of different kinds.
LogFacts facts_of(const std::vector<Log>& logs, const std::string& axis);

// Adds to `facts` what is identified with the motor's constant: mass or inertia of the load, friction, constant force
// or weight. `answers`: to all questions up to the encoder's; the load may be open; `logs`: those of `facts`. Throws
// LogError for logs whose effort is not what the motor's constant is for.
void identify_facts(LogFacts& facts, const SheetAnswers& answers, const std::vector<Log>& logs);

// Takes what the logs say of a `question` that `answers` leave open; whether they say it. `facts`: of the logs;
// `answers`: before the question, to which it is added.
bool take_from_logs(const LogFacts& facts, const SheetQuestion& question, SheetAnswers& answers);

// The marks of a file, and sentences on what contradicts between sheet and logs: the sheet's values are in the file.
struct MarkedSheet {
  LogMarks marks;
  std::vector<std::string> contradictions;
};

// What a file made of `answers`, of which `given` are those of a sheet, says of the logs with these `facts`.
MarkedSheet marks_of(const LogFacts& facts, const SheetAnswers& answers, const SheetAnswers& given);

}  // namespace stiction::host
