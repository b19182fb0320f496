// What a client of the control socket asked for: each accessor says what it wants, in the sentence of its refusal.
#pragma once

#include <stdexcept>

#include <nlohmann/json.hpp>

namespace inkwell::virtual_board {

/// A command that is refused; what() is the sentence for the client.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

const nlohmann::json& at(const nlohmann::json& request, const char* key, const char* what);
bool truth_value(const nlohmann::json& request, const char* key);
double checked_number(const nlohmann::json& value, const char* key, double minimum, double maximum);
double number(const nlohmann::json& request, const char* key, double minimum, double maximum);
double number_or(const nlohmann::json& request, const char* key, double otherwise, double minimum, double maximum);

}  // namespace inkwell::virtual_board
