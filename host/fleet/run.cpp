#include "host/fleet/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "sim/machine_file.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;
using FleetJson = nlohmann::ordered_json;

// FNV-1a, 64 bits: tells changed files, not forged ones.
class Fingerprint {
 public:
  void add(const std::string& text) {
    for (const char c : text) {
      value_ ^= static_cast<unsigned char>(c);
      value_ *= 1099511628211U;
    }
    value_ ^= text.size();
    value_ *= 1099511628211U;
  }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 14695981039346656037U;
};

FleetJson number_or_none(double value) { return std::isfinite(value) ? FleetJson(value) : FleetJson(nullptr); }

FleetJson kept_estimate(const RecordEstimate& estimate) {
  auto values = FleetJson::array();
  for (const auto& cause : estimate.causes)
    values.push_back({number_or_none(cause.value), number_or_none(cause.error)});
  return {{"values", std::move(values)}, {"message", estimate.message}};
}

RecordEstimate estimate_of(const FleetJson& kept) {
  RecordEstimate estimate;
  for (std::size_t c = 0; c < fleet_causes; ++c) {
    const auto& pair = kept.at("values").at(c);
    if (!pair.at(0).is_null()) estimate.causes[c].value = pair.at(0).get<double>();
    if (!pair.at(1).is_null()) estimate.causes[c].error = pair.at(1).get<double>();
  }
  estimate.message = kept.at("message").get<std::string>();
  return estimate;
}

// Finished work by the fingerprint of what it is of; a line each, so that a kill loses one at the most.
class Kept {
 public:
  explicit Kept(const fs::path& file) : file_(file) {
    std::ifstream in(file);
    std::string line;
    bool whole = true;
    while (std::getline(in, line)) {
      whole = !in.eof();
      const auto json = FleetJson::parse(line, nullptr, false);
      if (json.is_object() && json.contains("key")) known_[json["key"].get<std::string>()] = json;
    }
    out_.open(file, std::ios::app);
    if (!whole) out_ << '\n';  // of a line that a kill has cut
  }

  const FleetJson* find(const std::string& key) const {
    const auto found = known_.find(key);
    return found == known_.end() ? nullptr : &found->second;
  }

  // From any thread. Throws std::runtime_error.
  void add(const std::string& key, FleetJson result) {
    result["key"] = key;
    const std::lock_guard guard(mutex_);
    out_ << result.dump(-1, ' ', false, FleetJson::error_handler_t::replace) << '\n' << std::flush;
    if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written (is the disk full?)", file_.string()));
  }

 private:
  fs::path file_;
  std::map<std::string, FleetJson> known_;
  std::ofstream out_;
  std::mutex mutex_;
};

// Calls `work` with 0 .. `count` - 1 on `threads` threads; rethrows the first that one throws.
void for_each_on_threads(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> stopped = false;
  std::exception_ptr failure;
  std::mutex failing;
  const auto loop = [&] {
    try {
      for (std::size_t k = next++; k < count && !stopped; k = next++) work(k);
    } catch (...) {
      stopped = true;
      const std::lock_guard guard(failing);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned k = 1; k < std::min<std::size_t>(threads, count); ++k) workers.emplace_back(loop);
    loop();
  }
  if (failure) std::rethrow_exception(failure);
}

std::size_t axis_in(const machine::Machine& machine, const FleetAxis& axis, const std::string& place) {
  std::vector<std::string_view> names;
  for (std::size_t k = 0; k < machine.axes.size(); ++k) {
    if (machine.axes[k].name == axis.machine_axis) return k;
    names.push_back(machine.axes[k].name);
  }
  if (axis.machine_axis.empty() && names.size() == 1) return 0;
  throw machine::MachineFileError(
      axis.machine_axis.empty() ? fmt::format("{}: found no machine_axis of {}, and {} has {} axes; expected one of {}",
                                              place, axis.name, axis.machine, names.size(), fmt::join(names, ", "))
                                : fmt::format("{}: found machine_axis '{}' of {}; expected an axis of {}: {}{}", place,
                                              axis.machine_axis, axis.name, axis.machine, fmt::join(names, ", "),
                                              machine::did_you_mean(axis.machine_axis, names)));
}

class FleetRun {
 public:
  FleetRun(FleetResult& result, const FleetFolder& folder, const FleetSettings& settings)
      : result_(result), settings_(settings), kept_(folder.kept()) {
    std::map<fs::path, std::pair<machine::Machine, std::string>> files;
    for (const auto& axis : result_.list.axes) {
      if (!files.contains(axis.file)) files[axis.file] = {sim::read_machine(axis.file), machine::content_of(axis.file)};
      const auto& [machine, text] = files[axis.file];
      result_.machine_axes.push_back(axis_in(machine, axis, result_.list.records[axis.records.front()].place));
      result_.machines.push_back(machine);
      machine_texts_.push_back(text);
      AxisHistory history{axis.name, {}, {}};
      for (const auto record : axis.records) history.days.push_back(result_.list.records[record].day);
      history.records.resize(axis.records.size());
      result_.histories.push_back(std::move(history));
    }
  }

  void estimate_all() {
    const auto& records = result_.list.records;
    keys_.resize(records.size());
    std::atomic<std::size_t> done = 0, before = 0;
    for_each_on_threads(records.size(), settings_.threads, [&](std::size_t k) {
      const auto& record = records[k];
      auto& estimate = estimate_of_record(k);
      keys_[k] = key_of(record);
      const auto* known = keys_[k].empty() ? nullptr : kept_.find(keys_[k]);
      if (known != nullptr) {
        estimate = host::estimate_of(*known);
        ++before;
      } else {
        estimate = estimate_record(result_.machines[record.axis], result_.machine_axes[record.axis], record.file);
        if (!keys_[k].empty()) kept_.add(keys_[k], kept_estimate(estimate));
      }
      tell("records", ++done, records.size());
    });
    result_.judged_before = before;
  }

  void diagnose(const std::vector<std::size_t>& records) {
    std::mutex adding;
    std::atomic<std::size_t> done = 0;
    for_each_on_threads(records.size(), settings_.threads, [&](std::size_t k) {
      const auto index = records[k];
      RecordDiagnosis diagnosis;
      const auto key = keys_[index] + "/diagnosis";
      if (const auto* known = kept_.find(key)) {
        diagnosis = {known->at("causes").get<std::vector<std::string>>(), known->at("message").get<std::string>()};
      } else {
        const auto& record = result_.list.records[index];
        try {
          diagnosis.causes =
              diagnose_record(result_.machines[record.axis], result_.machine_axes[record.axis], record.file);
        } catch (const std::exception& error) {
          diagnosis.message = error.what();
        }
        kept_.add(key, {{"causes", diagnosis.causes}, {"message", diagnosis.message}});
      }
      {
        const std::lock_guard guard(adding);
        result_.diagnoses[index] = std::move(diagnosis);
      }
      tell("diagnoses", ++done, records.size());
    });
  }

  // Records that alarm, or all that could be judged.
  std::vector<std::size_t> to_diagnose() const {
    std::vector<std::size_t> records;
    for (const auto& axis : result_.trends.axes) {
      const auto& own = result_.list.axes[axis.history].records;
      for (std::size_t k = 0; k < own.size(); ++k) {
        const bool alarms = std::any_of(axis.causes.begin(), axis.causes.end(), [&](const CauseTrend& cause) {
          return cause.alarm && cause.alarm->record == k;
        });
        const bool judged = result_.histories[axis.history].records[k].judged();
        if ((alarms && settings_.diagnose_alarms) || (judged && settings_.diagnose_all)) records.push_back(own[k]);
      }
    }
    return records;
  }

 private:
  RecordEstimate& estimate_of_record(std::size_t index) {
    const auto axis = result_.list.records[index].axis;
    const auto& own = result_.list.axes[axis].records;
    const auto at = std::find(own.begin(), own.end(), index) - own.begin();
    return result_.histories[axis].records[static_cast<std::size_t>(at)];
  }

  // Empty for a log that cannot be read, which is tried at each run.
  std::string key_of(const FleetRecord& record) const {
    Fingerprint fingerprint;
    fingerprint.add(settings_.version);
    fingerprint.add(machine_texts_[record.axis]);
    fingerprint.add(result_.model(record.axis).name);
    try {
      fingerprint.add(machine::read_whole_file(record.file, "a log"));
    } catch (const machine::UnreadableFile&) {
      return {};
    }
    return fingerprint.text();
  }

  void tell(const std::string& step, std::size_t done, std::size_t all) const {
    if (settings_.progress) settings_.progress(step, done, all);
  }

  FleetResult& result_;
  const FleetSettings& settings_;
  Kept kept_;
  std::vector<std::string> machine_texts_;
  std::vector<std::string> keys_;
};

}  // namespace

FleetFolder::FleetFolder(fs::path folder) : folder_(std::move(folder)) {
  if (fs::exists(folder_) && !fs::is_directory(folder_))
    throw machine::MachineFileError(fmt::format("{}: found a file; expected a folder", folder_.string()));
  const auto state = folder_ / ".fleet";
  if (fs::exists(folder_) && !fs::exists(state) && !fs::is_empty(folder_))
    throw machine::MachineFileError(fmt::format(
        "{}: found files that are no results of a fleet; expected a new or empty folder, or that of a fleet "
        "to go on with",
        folder_.string()));
  std::error_code error;
  fs::create_directories(state, error);
  if (error) throw machine::MachineFileError(fmt::format("{}: cannot be made: {}", state.string(), error.message()));
  auto lock = FolderLock::attempt(state / "lock", 0);
  if (!lock)
    throw machine::MachineFileError(
        fmt::format("{}: found a process that works on it already; expected to be the only one", folder_.string()));
  lock_.push_back(std::move(*lock));
}

FleetResult run_fleet(FleetList list, const FleetFolder& folder, const FleetSettings& settings) {
  FleetResult result;
  result.list = std::move(list);
  FleetRun run(result, folder, settings);
  run.estimate_all();
  result.trends = trends_of(result.histories, settings.false_alarms);
  run.diagnose(run.to_diagnose());
  return result;
}

}  // namespace stiction::host
