// The firmware's register map for the compiler to write down as debug information, which it does for what is
// instantiated, and under the names that a class gives.
#include <registers/peripherals.hpp>

namespace inkwell::registers {

#define X(name, Map, base) template struct Map<base>;
INKWELL_CLAIMABLE_PERIPHERALS(X)
INKWELL_SHARED_PERIPHERALS(X)
#undef X

struct Peripherals {
#define X(name, Map, base) using name = Map<base>;
  INKWELL_CLAIMABLE_PERIPHERALS(X)
  INKWELL_SHARED_PERIPHERALS(X)
#undef X
} peripherals;

}  // namespace inkwell::registers
