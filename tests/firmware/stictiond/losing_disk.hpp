// A disk that loses power: it stops after any byte or operation, and of what was not brought to it keeps what it likes.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <vector>

#include "firmware/stictiond/file_operations.hpp"

namespace stiction::test {

struct PowerLost {};

// What a crash may leave, after the guarantees of POSIX and no more: bytes after the last sync of a file may be there
// up to any one of them, be zero, or be missing; of the changes of names since the last sync of the folder, any may be
// there and any not, but each whole.
class LosingDisk : public drive::FileOperations {
 public:
  // Power lasts for `steps` bytes and operations.
  void power_for(std::size_t steps) { steps_left_ = steps; }
  std::size_t steps_done() const { return steps_done_; }

  // The disk as it is found after the power came back.
  void power_on(std::mt19937_64& random) {
    for (const auto& change : changes_)
      if (random() % 2 == 0) change.apply(names_on_disk_);
    changes_.clear();
    names_ = names_on_disk_;
    for (auto& [name, file] : names_) file->bytes = file->on_disk = left_of(*file, random);
    steps_left_ = unlimited;
  }

  std::optional<std::string> read(const std::filesystem::path& file) override {
    const auto at = names_.find(file.string());
    if (at == names_.end()) return {};
    return at->second->bytes;
  }
  void create(const std::filesystem::path& file) override {
    step();
    const auto at = names_.find(file.string());
    if (at != names_.end()) {
      at->second->bytes.clear();
      return;
    }
    change({{}, file.string(), std::make_shared<File>()});
  }
  void append(const std::filesystem::path& file, std::string_view bytes) override {
    for (const char byte : bytes) {
      step();
      names_.at(file.string())->bytes += byte;
    }
  }
  void sync(const std::filesystem::path& file) override {
    step();
    auto& written = *names_.at(file.string());
    written.on_disk = written.bytes;
  }
  void sync_folder(const std::filesystem::path& /*folder*/) override {
    step();
    for (const auto& change : changes_) change.apply(names_on_disk_);
    changes_.clear();
  }
  void rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    step();
    change({from.string(), to.string(), names_.at(from.string())});
  }
  void link(const std::filesystem::path& file, const std::filesystem::path& name) override {
    step();
    if (names_.contains(name.string())) throw std::system_error(std::make_error_code(std::errc::file_exists));
    change({{}, name.string(), names_.at(file.string())});
  }
  void remove(const std::filesystem::path& file) override {
    step();
    if (names_.contains(file.string())) change({file.string(), {}, nullptr});
  }

 private:
  struct File {
    std::string bytes;    // as programs see it
    std::string on_disk;  // as it was synced
  };
  using Names = std::map<std::string, std::shared_ptr<File>>;
  struct Change {
    std::string gone, made;
    std::shared_ptr<File> file;
    void apply(Names& names) const {
      if (!gone.empty()) names.erase(gone);
      if (!made.empty()) names[made] = file;
    }
  };

  void step() {
    if (steps_left_ == 0) throw PowerLost{};
    if (steps_left_ != unlimited) --steps_left_;
    ++steps_done_;
  }
  void change(const Change& change) {
    change.apply(names_);
    changes_.push_back(change);
  }
  static std::string left_of(const File& file, std::mt19937_64& random) {
    if (file.bytes == file.on_disk) return file.bytes;
    std::string left = file.on_disk;
    switch (random() % 4) {
      case 0:
        return left;
      case 1:
        return {};
      case 2:
        return std::string(file.bytes.size(), '\0');
      default: {
        const std::size_t there = random() % (file.bytes.size() + 1);
        left = file.bytes.substr(0, there);
        if (random() % 2 == 0) left.resize(file.bytes.size(), '\0');
        return left;
      }
    }
  }

  static constexpr std::size_t unlimited = static_cast<std::size_t>(-1);
  Names names_, names_on_disk_;
  std::vector<Change> changes_;
  std::size_t steps_left_ = unlimited;
  std::size_t steps_done_ = 0;
};

}  // namespace stiction::test
