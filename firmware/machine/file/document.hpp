// The TOML text behind a machine: file, overrides of an experiment and `--set` merged into one tree whose nodes keep
// where they came from, so that every complaint names its place.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <vector>

#include "firmware/machine/file/machine_file.hpp"

namespace stiction::machine {

class Document {
 public:
  // `file` is the name shown in messages, `text` its content. Throws MachineFileError for invalid TOML.
  Document(std::string file, std::string text);

  const toml::table& root() const { return root_; }

  // From now on attempt() keeps what its checks throw, so that report() tells all errors of a file at once.
  void collect_errors() { collects_ = true; }

  // Runs `check`. Unless errors are collected it throws what `check` throws.
  template <class Check>
  void attempt(Check&& check) const {
    if (!collects_) return check();
    try {
      check();
    } catch (const MachineFileError& error) {
      keep(error.what());
    }
  }
  bool has_errors() const { return !errors_.empty(); }
  std::size_t errors() const { return errors_.size(); }

  // Throws MachineFileError with all errors that were collected, a line each; does nothing where there is none.
  void report() const;

  // Merges [experiment.NAME], if the file has it. The file itself must have been found valid before.
  void apply_experiment(std::string_view name);

  // Merges "axis.X.mass=230 kg". The value is TOML or a bare text; "axis.*.mass" means every axis; an empty value
  // removes the key.
  void apply_set(std::string_view assignment);

  // "FILE:LINE: KEY", as messages name a place.
  std::string place(const toml::source_region& place, std::string_view key) const;

  // Throws MachineFileError "PLACE: KEY: found ...; expected ...". `where` in the file; `key` with its path; `found`
  // and `expected` as the message has them.
  [[noreturn]] void fail(const toml::source_region& where, std::string_view key, std::string_view found,
                         std::string_view expected) const;

  // Refuses a key that is not among `known`, with the nearest of them as suggestion. `place` in the file; `key` as it
  // was found.
  [[noreturn]] void fail_unknown(const toml::source_region& place, std::string_view key,
                                 const std::vector<std::string_view>& known) const;

 private:
  void refuse_unchangeable(const toml::table& changes) const;
  void overlay(toml::table& changes);
  void keep(std::string error) const;
  void set_one(const std::string& tag, const std::string& key, const std::string& value);

  std::string file_;
  std::string text_;
  toml::table root_;
  bool collects_ = false;
  mutable std::vector<std::string> errors_;
};

// A key below a table: "axis.X" and "mass" make "axis.X.mass".
std::string join_key(std::string_view table, std::string_view key);

// A node as a message shows it: "3 kg" in quotes, 3, a table, a list.
std::string describe_node(const toml::node& node);

}  // namespace stiction::machine
