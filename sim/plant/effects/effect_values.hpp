// Between the typed parameters of an effect and the values by key that a machine file, a verdict or a fit has.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/machine/model/effect.hpp"
#include "firmware/machine/model/parameter.hpp"

namespace stiction::sim {

// Values that an effect cannot have, alone or on this axis.
using EffectError = machine::ValueError;

namespace detail {

template <class Member>
inline constexpr bool is_list = std::is_same_v<Member, std::vector<double>>;

template <class Owner>
void assign(std::string_view effect, const machine::Parameter<Owner>& p, const std::vector<double>& values,
            Owner& owner) {
  for (const double value : values)
    if (!p.range.contains(value))
      throw EffectError(effect, fmt::format("{} = {:g} {}", p.key, value, p.unit), "a value in the range of this key");
  std::visit(
      [&]<class Member>(Member Owner::*member) {
        if (!is_list<Member> && values.size() != 1)
          throw EffectError(effect, fmt::format("{} values of {}", values.size(), p.key), "one value");
        if constexpr (is_list<Member>)
          owner.*member = values;
        else
          owner.*member = static_cast<Member>(values.front());
      },
      p.member);
}

template <class Owner>
bool is_optional(const machine::Parameter<Owner>& p) {
  return std::holds_alternative<std::optional<double> Owner::*>(p.member);
}

template <class E>
bool has_key(std::string_view key) {
  return std::any_of(E::parameters.begin(), E::parameters.end(), [&](const auto& p) { return p.key == key; });
}

}  // namespace detail

// Every key of the effect with its value; no key for an optional one that has none.
template <class E>
machine::Effect effect_of(const typename E::Parameters& parameters) {
  machine::Effect effect{std::string(E::name), {}};
  for (const auto& p : E::parameters)
    std::visit(
        [&]<class Member>(Member E::Parameters::*member) {
          const std::string key(p.key);
          if constexpr (detail::is_list<Member>) {
            effect.values[key] = parameters.*member;
          } else if constexpr (std::is_arithmetic_v<Member>) {
            effect.values[key] = {static_cast<double>(parameters.*member)};
          } else {
            if (parameters.*member) effect.values[key] = {*(parameters.*member)};
          }
        },
        p.member);
  return effect;
}

// A key that is left out takes its default. Throws EffectError for a missing or unknown key, for a value out of range
// and where E::check() refuses the values together.
template <class E>
typename E::Parameters parameters_of(const machine::Effect& effect) {
  for (const auto& [key, values] : effect.values)
    if (!detail::has_key<E>(key)) throw EffectError(E::name, fmt::format("the key {}", key), "none but its own keys");
  typename E::Parameters parameters;
  for (const auto& p : E::parameters) {
    const auto found = effect.values.find(std::string(p.key));
    if (found == effect.values.end() && detail::is_optional(p)) continue;
    if (found == effect.values.end() && !p.fallback) throw EffectError(E::name, fmt::format("no {}", p.key), "one");
    detail::assign(E::name, p, found == effect.values.end() ? std::vector{*p.fallback} : found->second, parameters);
  }
  if constexpr (requires { E::check(parameters); }) E::check(parameters);
  return parameters;
}

}  // namespace stiction::sim
