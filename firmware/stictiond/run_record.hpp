// What a run leaves behind for the next one, in the folder of the parameters: that it runs, and how it ended where that
// was not in order. Its lock keeps a second drive from the same folder, whose parameters and machine are the first
// one's.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace stiction::drive {

class RunRecord {
 public:
  // Opens FOLDER/run. Throws StartRefused where a different drive holds it or it cannot be had. `folder`: of
  // --parameters; empty: nothing is kept.
  explicit RunRecord(const std::filesystem::path& folder);
  ~RunRecord();
  RunRecord(const RunRecord&) = delete;
  RunRecord& operator=(const RunRecord&) = delete;

  // How the last run ended, as far as it could say: "while running", "by SIGSEGV"; none: in order.
  const std::optional<std::string>& broken_off() const { return broken_off_; }

  // From now on until end() a run that ends has not ended in order.
  void begin();
  void end();

  // In a signal's handler (hal::install_signal_reactions): the record says by which signal the run ended.
  static void note_signal(int signal) noexcept;

 private:
  int descriptor_ = -1;
  std::optional<std::string> broken_off_;
};

}  // namespace stiction::drive
