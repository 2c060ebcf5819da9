// What is wrong with a command line that CLI11 refuses, in the words of the other messages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace stiction::host {

// "OPTION: found ...; expected ...; did you mean ...? (see `stiction COMMAND --help`)". `program` knows the commands,
// `arguments` are as typed, without the programme's name, and `error` is what CLI11 says of them. An unknown option is
// told before anything that is missing: the one is often the other, misspelt.
std::string usage_message(const CLI::App& program, const std::vector<std::string>& arguments,
                          const CLI::ParseError& error);

// The message for an option, `name` as typed, that `command` does not have.
std::string unknown_option(const CLI::App& command, const std::string& name);

// The words of the command that `arguments` call, "simulate circle"; empty: none.
std::string called_command(const CLI::App& program, const std::vector<std::string>& arguments);

// The words that call a command, "stiction simulate circle".
std::string command_words(const CLI::App& command);

}  // namespace stiction::host
