#include "host/sweep/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "firmware/machine/file/machine_file.hpp"
#include "firmware/machine/file/nearest_name.hpp"
#include "firmware/machine/file/whole_file.hpp"
#include "host/sweep/folder_lock.hpp"

namespace stiction::host {
namespace {

namespace fs = std::filesystem;

// Places of the lock file.
constexpr std::uint64_t plan_place = 0;
constexpr std::uint64_t finish_place = 1;
constexpr std::uint64_t first_chunk_place = 2;

constexpr auto wait_for_others = std::chrono::milliseconds(100);

std::string duration_words(double seconds) {
  if (seconds < 120.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2.0 * 3600.0) return fmt::format("{:.0f} min", seconds / 60.0);
  if (seconds < 2.0 * 86400.0) return fmt::format("{:.0f} h", seconds / 3600.0);
  if (seconds < 2.0 * 31557600.0) return fmt::format("{:.0f} days", seconds / 86400.0);
  return fmt::format("{:.0f} years", seconds / 31557600.0);
}

// What the first rows that were tried tell.
struct Trial {
  std::vector<SweepFigure> figures;
  double seconds = 0.0;  // of a run, mean
  std::size_t runs = 0;
};

// Rows that are likely to differ: the first, the last, and those between.
std::vector<std::uint64_t> rows_to_try(std::uint64_t rows) {
  std::vector<std::uint64_t> all{0, rows / 2, rows - 1, rows / 4, rows - 1 - rows / 4};
  std::vector<std::uint64_t> once;
  for (const auto row : all)
    if (std::find(once.begin(), once.end(), row) == once.end()) once.push_back(row);
  return once;
}

Trial try_rows(const SweepSpec& spec, const SweepCommand& command, const SweepRows& rows) {
  constexpr std::size_t enough = 3;
  constexpr double enough_seconds = 5.0;
  Trial trial;
  std::string first_failure;
  double total = 0.0;
  for (const auto index : rows_to_try(rows.size())) {
    if (!trial.figures.empty() && (trial.runs >= enough || total > enough_seconds)) break;
    const auto begin = std::chrono::steady_clock::now();
    const auto row = rows.row(index);
    try {
      auto figures = command.run(command, row);
      if (trial.figures.empty()) trial.figures = std::move(figures);
    } catch (const std::exception& error) {
      if (first_failure.empty()) first_failure = error.what();
    }
    total += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++trial.runs;
  }
  trial.seconds = total / static_cast<double>(trial.runs);
  if (trial.figures.empty())
    throw machine::MachineFileError(
        fmt::format("{}: found that none of the {} runs that were tried succeeds, the first: "
                    "{}; expected runs that give figures",
                    spec.file, trial.runs, first_failure));
  return trial;
}

// Those that the specification asks for; all where it asks for none. Figures of one name are told apart by nothing.
std::vector<SweepFigure> wanted_figures(const SweepSpec& spec, const std::vector<SweepFigure>& given) {
  std::vector<std::string_view> names;
  for (const auto& figure : given) names.push_back(figure.name);
  const auto require = [&](const std::string& key, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw machine::MachineFileError(fmt::format("{}: {}: found \"{}\", which no run gives; expected one of {}{}",
                                                  spec.file, key, name, fmt::join(names, ", "),
                                                  machine::did_you_mean(name, names)));
  };
  auto wanted = spec.figures;
  for (const auto& name : spec.figures) require("figures", name);
  const auto collect = [&](const std::string& key, const std::string& name) {
    if (name.empty()) return;
    require(key, name);
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
  };
  for (const auto& name : spec.pareto) collect("pareto", name);
  collect("worst", spec.worst);
  collect("robust", spec.robust);
  std::vector<SweepFigure> all;
  for (const auto& figure : given) {
    const bool here = wanted.empty() || std::find(wanted.begin(), wanted.end(), figure.name) != wanted.end();
    const bool known =
        std::any_of(all.begin(), all.end(), [&](const SweepFigure& each) { return each.column() == figure.column(); });
    if (here && !known) all.push_back({figure.name, figure.unit, 0.0});
  }
  return all;
}

void refuse_without_yes(const SweepSpec& spec, const Trial& trial, const SweepSettings& settings) {
  const double workers = static_cast<double>(settings.threads) * settings.processes;
  const double seconds = trial.seconds * static_cast<double>(spec.rows()) / workers;
  if (settings.yes || seconds <= longest_unasked) return;
  throw machine::MachineFileError(fmt::format(
      "{}: found {} runs, which take about {} on {:.0f} threads ({:.3g} s each, measured on {}); expected at "
      "most {}, or --yes",
      spec.file, spec.rows(), duration_words(seconds), workers, trial.seconds, trial.runs,
      duration_words(longest_unasked)));
}

// The plan of the folder, made by the first who comes.
SweepPlan agreed_plan(const SweepSpec& spec, const SweepCommand& command, const SweepRows& rows,
                      const SweepFolder& folder, const SweepSettings& settings) {
  const bool made = !fs::exists(folder.state());
  const bool made_above = !fs::exists(folder.path());
  std::error_code refused;
  fs::create_directories(folder.state(), refused);
  if (refused)
    throw machine::MachineFileError(fmt::format("{}: found that it cannot be made: {}; expected a folder to write in",
                                                folder.path().string(), refused.message()));
  const auto turn = FolderLock::wait(folder.locks(), plan_place);
  SweepPlan own{build_identity(settings.version), input_identity(spec), rows.size(), chunk_length(rows.size()), {}};
  const auto file = folder.state() / "plan";
  if (fs::exists(file)) {
    const auto found = parse_plan(machine::read_whole_file(file, "the plan of a sweep"));
    if (found) {
      require_same(*found, own, folder.path());
      return *found;
    }
    throw machine::MachineFileError(
        fmt::format("{}: found no plan of a sweep that this programme knows; expected a new folder", file.string()));
  }
  try {
    const auto trial = try_rows(spec, command, rows);
    own.figures = wanted_figures(spec, trial.figures);
    refuse_without_yes(spec, trial, settings);
    fs::create_directories(folder.state() / "chunks");
    put_file(file, own.text());
  } catch (...) {
    // Nothing is left of a sweep that has not begun.
    std::error_code ignored;
    if (made) fs::remove_all(folder.state(), ignored);
    if (made_above) fs::remove(folder.path(), ignored);
    throw;
  }
  return own;
}

ChunkResult run_chunk(const SweepCommand& command, const SweepRows& rows, const SweepPlan& plan, std::uint64_t first,
                      std::uint64_t count) {
  ChunkResult result;
  for (std::uint64_t k = 0; k < count; ++k) {
    std::vector<double> values(plan.figures.size(), std::numeric_limits<double>::quiet_NaN());
    std::string message;
    try {
      const auto figures = command.run(command, rows.row(first + k));
      for (std::size_t f = 0; f < values.size(); ++f)
        for (const auto& figure : figures)
          if (figure.name == plan.figures[f].name && figure.unit == plan.figures[f].unit) {
            values[f] = figure.value;
            break;
          }
    } catch (const std::bad_alloc&) {
      throw;  // of this machine, not of the row
    } catch (const std::exception& error) {
      message = error.what();
      if (message.empty()) message = "failed";
    }
    result.figures.insert(result.figures.end(), values.begin(), values.end());
    result.status.push_back(message.empty() ? RowStatus::done : RowStatus::failed);
    result.message.push_back(std::move(message));
  }
  return result;
}

// The chunks as this process knows them, shared out among its threads.
class ChunkBoard {
 public:
  ChunkBoard(const ChunkFiles& files, const SweepFolder& folder, const SweepSettings& settings, std::uint64_t rows)
      : files_(files), folder_(folder), settings_(settings), rows_(rows), done_(files.count(), false) {
    // Read, not only looked for: a crash of the machine may have left one damaged, which is then run again.
    for (std::uint64_t k = 0; k < files.count(); ++k)
      if (files.read(k)) mark(k);
  }

  struct Claim {
    std::uint64_t chunk;
    FolderLock lock;
  };
  // A chunk that nobody works on, after waiting for those that others work on; none when all are done, or on stop().
  std::optional<Claim> next() {
    for (;;) {
      bool open = false;
      for (std::uint64_t tried = 0; tried < done_.size(); ++tried) {
        const auto k = candidate();
        if (!k) break;
        auto lock = FolderLock::attempt(folder_.locks(), first_chunk_place + *k);
        if (!lock) {
          open = true;
          // Another thread or process has it; it may be done when we look again.
          const std::lock_guard guard(mutex_);
          cursor_ = (*k + 1) % done_.size();
          continue;
        }
        // Who makes the results removes the chunks after them.
        if (files_.has(*k) || folder_.complete()) {
          finish(*k);
          continue;
        }
        return Claim{*k, std::move(*lock)};
      }
      if (!open && !candidate()) return std::nullopt;
      if (stopped_) return std::nullopt;
      std::this_thread::sleep_for(wait_for_others);
      look_again();
    }
  }

  void finish(std::uint64_t chunk) {
    const std::lock_guard guard(mutex_);
    mark(chunk);
    if (settings_.progress) settings_.progress(done_rows_, rows_);
  }
  void stop() { stopped_ = true; }
  std::uint64_t done_rows() const { return done_rows_; }

 private:
  // The next chunk that is not known to be done.
  std::optional<std::uint64_t> candidate() {
    const std::lock_guard guard(mutex_);
    if (stopped_) return std::nullopt;
    for (std::uint64_t tried = 0; tried < done_.size(); ++tried) {
      const auto k = cursor_;
      cursor_ = (cursor_ + 1) % done_.size();
      if (!done_[k]) return k;
    }
    return std::nullopt;
  }

  void look_again() {
    const std::lock_guard guard(mutex_);
    const bool complete = folder_.complete();
    for (std::uint64_t k = 0; k < done_.size(); ++k)
      if (!done_[k] && (complete || files_.has(k))) mark(k);
    if (settings_.progress) settings_.progress(done_rows_, rows_);
  }

  void mark(std::uint64_t chunk) {
    if (done_[chunk]) return;
    done_[chunk] = true;
    done_rows_ += files_.rows_of(chunk);
  }

  const ChunkFiles& files_;
  const SweepFolder& folder_;
  const SweepSettings& settings_;
  std::uint64_t rows_;
  std::mutex mutex_;
  std::vector<bool> done_;
  std::uint64_t cursor_ = 0;
  std::uint64_t done_rows_ = 0;
  std::atomic<bool> stopped_ = false;
};

}  // namespace

SweepFolder::SweepFolder(fs::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) throw machine::MachineFileError("--out: found none; expected the folder of the results");
  if (fs::exists(folder_) && !fs::is_directory(folder_))
    throw machine::MachineFileError(fmt::format("{}: found a file; expected a folder", folder_.string()));
  if (!fs::exists(folder_) || fs::exists(state()) || fs::is_empty(folder_)) return;
  throw machine::MachineFileError(
      fmt::format("{}: found files that are no sweep; expected a new or empty folder, or that of a sweep to resume",
                  folder_.string()));
}

bool SweepFolder::complete() const {
  std::error_code none;
  return fs::exists(table(), none);
}

void finish_once(const SweepFolder& folder, const std::function<void()>& make) {
  const auto turn = FolderLock::wait(folder.locks(), finish_place);
  if (!folder.complete()) make();
}

void put_file(const fs::path& place, const std::string& content) {
  auto pending = place;
  pending += ".part";
  std::error_code error;
  try {
    machine::write_whole_file(pending, content, place);
  } catch (...) {
    fs::remove(pending, error);
    throw;
  }
  fs::rename(pending, place, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be written: {}", place.string(), error.message()));
}

ChunkFiles chunk_files(const SweepFolder& folder, const SweepPlan& plan) {
  return {folder.state() / "chunks", plan.rows, plan.chunk, plan.figures.size()};
}

SweepPlan run_sweep(const SweepSpec& spec, const SweepCommand& command, const SweepFolder& folder,
                    const SweepSettings& settings) {
  const SweepRows rows(spec, command);
  const auto plan = agreed_plan(spec, command, rows, folder, settings);
  if (folder.complete()) return plan;
  const auto files = chunk_files(folder, plan);
  ChunkBoard board(files, folder, settings, plan.rows);
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    try {
      while (const auto claim = board.next()) {
        files.write(claim->chunk,
                    run_chunk(command, rows, plan, files.first_row(claim->chunk), files.rows_of(claim->chunk)));
        board.finish(claim->chunk);
      }
    } catch (...) {
      board.stop();
      const std::lock_guard guard(failing);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned k = 1; k < settings.threads; ++k) workers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
  return plan;
}

}  // namespace stiction::host
