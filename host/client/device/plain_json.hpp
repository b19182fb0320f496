// Parses JSON from another program or a file.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/plain_text.hpp"

namespace inkwell::device {

/// Parses JSON and makes its texts safe to print. Throws nlohmann::json::exception.
inline nlohmann::json parse_plain_json(std::string_view text) {
  return nlohmann::json::parse(text, [](int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
    if (event == nlohmann::json::parse_event_t::value && parsed.is_string())
      parsed = protocol::plain_lines(parsed.get_ref<const std::string&>());
    return true;
  });
}

}  // namespace inkwell::device
