// The vector table has nothing where HardFault's handler belongs.
#include "support.hpp"

void run() {
  set_handler(3, nullptr);
  results[0] = finished;
  word(0x60000000) = 0;
}
