#include "requests.hpp"

#include <fmt/format.h>

namespace inkwell::virtual_board {

using nlohmann::json;

const json& at(const json& request, const char* key, const char* what) {
  const auto found = request.find(key);
  if (found == request.end()) throw Refused(fmt::format("\"{}\" is missing: {}", key, what));
  return *found;
}

bool truth_value(const json& request, const char* key) {
  const json& value = at(request, key, "true or false");
  if (!value.is_boolean()) throw Refused(fmt::format("\"{}\" must be true or false", key));
  return value.get<bool>();
}

double checked_number(const json& value, const char* key, double minimum, double maximum) {
  if (!value.is_number()) throw Refused(fmt::format("\"{}\" must hold numbers only", key));
  const double number = value.get<double>();
  if (!(number >= minimum && number <= maximum))
    throw Refused(fmt::format("\"{}\" holds {}, which is outside {} to {}", key, number, minimum, maximum));
  return number;
}

double number(const json& request, const char* key, double minimum, double maximum) {
  return checked_number(at(request, key, "a number"), key, minimum, maximum);
}

double number_or(const json& request, const char* key, double otherwise, double minimum, double maximum) {
  return request.contains(key) ? number(request, key, minimum, maximum) : otherwise;
}

}  // namespace inkwell::virtual_board
