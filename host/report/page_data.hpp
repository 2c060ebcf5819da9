// What the reports' pages have in common: their frame, the machine, the conditions of a run, arrays as the page's
// scripts read them.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/model/machine.hpp"
#include "host/report/origin.hpp"

namespace stiction::host {

// Ten digits: a feed that came from "3.2 m/min" is 3.2 again, and equal feeds of two runs are equal in the page.
double rounded(double value);

// Appends unless it is there already.
void add_once(nlohmann::ordered_json& list, const nlohmann::ordered_json& value);

// The chosen elements times `scale`, for decodeFloats() of page.js. `values`: of a channel; `chosen`: indices; `scale`:
// factor.
std::string packed(std::span<const double> values, std::span<const std::size_t> chosen, double scale = 1.0);

// Name, periods, axes and the rows of machine_sheet.hpp, for drawMachine() of machine.js.
nlohmann::ordered_json machine_json(const machine::Machine& machine);

// Items of drawConditions() of machine.js: { label, value }.
class Conditions {
 public:
  void add(const char* label, const std::string& value) { list_.push_back({{"label", label}, {"value", value}}); }
  const nlohmann::ordered_json& json() const { return list_; }

 private:
  nlohmann::ordered_json list_ = nlohmann::ordered_json::array();
};

// Strings with ", " between them.
std::string joined(const nlohmann::ordered_json& list);

// "estimated" when it holds for all axes, else "X estimated, Y ideal".
std::string by_axis(const machine::Machine& machine, const std::function<std::string(const machine::AxisModel&)>& text);

// "fixed" and "double" for readers.
std::string signals_text(const std::string& signals);

// "MCFV 5050 LN cross table (mcfv5050ln)". `machine`: of the report.
std::string name_and_id(const machine::Machine& machine);

struct PageFrame {
  std::string kind;      // "Diagnosis"; plain text, as the following
  std::string title;     // "Diagnosis: MCFV 5050 LN cross table"
  std::string sentence;  // the one at the head: what was found, and what it is worth
  std::string command;   // the command line that made the page
  std::string version;   // of stiction
  std::string machine;   // its name and id
  Origin origin;         // date, machine file, source files, sample rate
};

// A whole page: frame.html around `body`, which has the markers {{opening}} (title, sentence, origin) and {{closing}}
// (machine sheet) and those of `texts`, whose values are HTML. `scripts` run in their order, behind those that all
// pages have. `data`: becomes DATA of the scripts.
std::string report_page(const PageFrame& frame, std::string_view body,
                        std::map<std::string, std::string, std::less<>> texts, const nlohmann::ordered_json& data,
                        std::initializer_list<std::string_view> scripts);

}  // namespace stiction::host
