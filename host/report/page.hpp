// Filling a page template and packing numbers into it. A page is one file: style, scripts and data lie inside it, and
// it loads nothing.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace stiction::host {

// Text for an element's content or a quoted attribute: & < > " ' as entities.
std::string escape_html(std::string_view text);

// JSON for the content of a <script type="application/json">: no "</" and no "<!--" in it can end or swallow the
// element. Text that is not UTF-8 is repaired, not refused.
std::string json_for_script(const nlohmann::ordered_json& json);

// 32-bit little-endian floats in base64 (RFC 4648), what the page's script decodes into a Float32Array.
std::string base64_floats(std::span<const float> values);

// Replaces each {{name}} of the template by its text; what is put in is not searched again. Throws
// std::invalid_argument for a marker without text and for a text without marker.
std::string fill_template(std::string_view page, const std::map<std::string, std::string, std::less<>>& texts);

}  // namespace stiction::host
