// Runs the rows of a sweep, on the threads of this process and together with whoever else works on the same folder:
// ranks of an MPI job, tasks of a batch system, programmes that were started by hand. They share the folder and need no
// other connection, so that one that dies takes nothing with it: its chunk is done again by those who are left.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host/sweep/chunks.hpp"
#include "host/sweep/plan.hpp"

namespace stiction::host {

struct SweepSettings {
  std::string version;     // of the programme
  unsigned threads = 1;    // of this process
  unsigned processes = 1;  // that work on the sweep, as far as the launcher tells; for the estimate alone
  bool yes = false;        // whether a sweep that takes long may begin
  // After each chunk that is done, by whomever: rows that are done of all. From any thread.
  std::function<void(std::uint64_t done, std::uint64_t rows)> progress = {};
};

// Seconds above which a sweep wants a yes.
inline constexpr double longest_unasked = 600.0;

// The place of the results, and who writes them.
class SweepFolder {
 public:
  // `folder`: new, empty, or of the same sweep. Throws machine::MachineFileError for one that holds anything else.
  explicit SweepFolder(std::filesystem::path folder);

  const std::filesystem::path& path() const { return folder_; }
  std::filesystem::path state() const { return folder_ / ".sweep"; }
  std::filesystem::path locks() const { return state() / "locks"; }
  std::filesystem::path table() const { return folder_ / "sweep.npz"; }
  bool complete() const;  // the results are there

 private:
  std::filesystem::path folder_;
};

// Runs what is missing of `spec` by `command` in `folder`, with the threads of `settings`, and returns when every chunk
// is done. The first who comes tries some rows, to know the figures and the time that a run takes. Throws
// machine::MachineFileError for what the folder or the specification has wrong, and for a sweep longer than
// longest_unasked without a yes; std::runtime_error when a result cannot be written.
SweepPlan run_sweep(const SweepSpec& spec, const SweepCommand& command, const SweepFolder& folder,
                    const SweepSettings& settings);

// Calls `make`, which writes the results of a sweep whose chunks are all done, in one of the processes that work on
// `folder`; returns in each when they are there. What `make` throws it throws.
void finish_once(const SweepFolder& folder, const std::function<void()>& make);

// Puts `content` at `place` as a whole. Throws std::runtime_error.
void put_file(const std::filesystem::path& place, const std::string& content);

// The files of the chunks of `plan` in `folder`.
ChunkFiles chunk_files(const SweepFolder& folder, const SweepPlan& plan);

}  // namespace stiction::host
