// Calls a library and runs for half a second.
#include <unistd.h>

extern "C" int answer_of_other_library();

int main() {
  constexpr useconds_t half_a_second_us = 500'000;
  usleep(half_a_second_us);
  return answer_of_other_library();
}
