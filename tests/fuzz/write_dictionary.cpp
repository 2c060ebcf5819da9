// Writes the words of a machine file as a dictionary of libFuzzer to standard output, made from the keys' descriptions.
#include <fmt/format.h>

#include <set>
#include <string>

#include "firmware/machine/file/parameters.hpp"
#include "sim/effects/effects.hpp"
#include "sim/machine_file.hpp"
#include "sim/plant/friction/laws.hpp"

int main() {
  namespace machine = stiction::machine;
  namespace sim = stiction::sim;
  std::set<std::string> words{std::string(machine::machine_schema),
                              "axis.",
                              "axis.*.",
                              "experiment.",
                              "[reference.circle]",
                              "[[axis.B.effect]]"};
  for (const auto name : machine::experiment_names) words.emplace(name);
  for (const auto& choice : machine::motor_models) words.emplace(choice.name);
  for (const auto& choice : machine::velocity_sources) words.emplace(choice.name);
  for (const auto& choice : machine::reference_sources) words.emplace(choice.name);
  sim::for_each_friction_model([&]<class Model>() { words.emplace(Model::name); });
  for (const auto effect : sim::all_effects()) words.insert(effect.name());
  for (const auto& table : sim::machine_file_description()) {
    words.insert(table.name);
    for (const auto& key : table.keys) {
      words.insert(key.key);
      if (!key.unit.empty()) words.insert(key.unit);
    }
  }
  // Of mapping files and of what they map (recording_fuzz).
  for (const char* word : {"stiction.mapping/1",
                           "[[channel]]",
                           "[table]",
                           "[time]",
                           "from",
                           "to",
                           "unit",
                           "amperes",
                           "peak",
                           "rms",
                           "reverse",
                           "fill",
                           "hold",
                           "linear",
                           "separator",
                           "decimal",
                           "header_line",
                           "column",
                           "period",
                           "Name\\x09",
                           "SampleTime[ms]",
                           "SymbolName",
                           "Unit",
                           "StartRecord",
                           "EOF",
                           "Header",
                           "CycleTimeMs",
                           "SignalListHFData",
                           "Payload",
                           "HFData",
                           "Address",
                           "CYCLE"})
    words.emplace(word);
  for (const char* unit : {"us", "ms", "mm", "um", "nm", "m/min", "mH", "kN", "degC", "%", "rpm"}) words.emplace(unit);
  for (const auto& word : words)
    if (!word.empty()) fmt::print("\"{}\"\n", word);
}
