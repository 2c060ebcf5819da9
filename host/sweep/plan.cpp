#include "host/sweep/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/whole_file.hpp"

namespace stiction::host {
namespace {

constexpr const char* plan_schema = "stiction.sweep-plan/1";

// FNV-1a of 64 bits: tells builds and files apart that differ by accident, which is all that it has to.
class Digest {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

std::string SweepPlan::text() const {
  auto list = nlohmann::ordered_json::array();
  for (const auto& figure : figures) list.push_back({{"name", figure.name}, {"unit", figure.unit}});
  return nlohmann::ordered_json{{"schema", plan_schema}, {"version", version}, {"input", input},
                                {"rows", rows},          {"chunk", chunk},     {"figures", std::move(list)}}
             .dump(2) +
         "\n";
}

std::optional<SweepPlan> parse_plan(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    if (json.at("schema") != plan_schema) return std::nullopt;
    SweepPlan plan{json.at("version"), json.at("input"), json.at("rows"), json.at("chunk"), {}};
    for (const auto& each : json.at("figures")) plan.figures.push_back({each.at("name"), each.at("unit"), 0.0});
    if (plan.chunk == 0) return std::nullopt;
    return plan;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void require_same(const SweepPlan& found, const SweepPlan& own, const std::filesystem::path& folder) {
  if (found.version != own.version)
    throw machine::MachineFileError(fmt::format(
        "{}: found a sweep by stiction {}; expected one by the programme that runs here, {}, since results of "
        "different programmes do not mix",
        folder.string(), found.version, own.version));
  if (found.input != own.input)
    throw machine::MachineFileError(
        fmt::format("{}: found the sweep of a different specification, or of machine files or logs that have changed "
                    "since; expected the same, or a new folder",
                    folder.string()));
}

std::string build_identity(const std::string& version) {
  Digest digest;
  digest.add(machine::read_whole_file("/proc/self/exe", "the programme"));
  return fmt::format("{}, build {}", version, digest.text());
}

std::string input_identity(const SweepSpec& spec) {
  Digest digest;
  digest.add(spec.text);
  for (const auto& key : spec.keys) {
    if (key.kind == SweptKey::Kind::machine)
      for (const auto& name : key.values) digest.add(machine::content_of(machine::find_machine(name)));
    if (key.kind == SweptKey::Kind::log)
      for (const auto& name : key.values) digest.add(machine::read_whole_file(name, "a log"));
  }
  return digest.text();
}

std::uint64_t chunk_length(std::uint64_t rows) { return std::clamp<std::uint64_t>(rows / 1000, 1, 10000); }

}  // namespace stiction::host
