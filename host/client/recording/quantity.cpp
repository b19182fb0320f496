#include "host/client/recording/quantity.hpp"

#include <algorithm>

namespace inkwell::recording {
namespace {

void remove_suffix(std::string& text, std::string_view suffix) {
  if (!suffix.empty() && text.ends_with(suffix)) text.resize(text.size() - suffix.size());
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  return std::visit([](auto each) { return protocol::info(each).name; }, quantity);
}

std::string_view unit_of(Quantity quantity) {
  return std::visit([](auto each) { return protocol::info(each).unit; }, quantity);
}

std::string words_of(Quantity quantity) {
  std::string name(name_of(quantity)), unit(unit_of(quantity));
  std::replace(unit.begin(), unit.end(), '/', '_');
  if (!unit.empty()) remove_suffix(name, "_" + unit);
  for (const char* part : {"_x", "_y", "_z", "_1", "_2", "_3"}) remove_suffix(name, part);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace inkwell::recording
