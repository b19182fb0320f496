#include "host/client/guides/guides.hpp"

#include <string>

namespace inkwell::guides {

Guide Offer::start(const Choices& choices) const { return {std::string(name), std::string(title), plan(choices)}; }

std::span<const Offer* const> all_guides() {
  static constexpr std::array all{
#define X(name) &name##_guide,
      INKWELL_GUIDES(X)
#undef X
  };
  return all;
}

}  // namespace inkwell::guides
