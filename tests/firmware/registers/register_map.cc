// Instantiates all register maps of the firmware, so that the debug information contains them under their class names.
#include "firmware/registers/peripherals.hpp"

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
