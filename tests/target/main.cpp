#define DOCTEST_CONFIG_IMPLEMENT
#define DOCTEST_CONFIG_NO_POSIX_SIGNALS
#define DOCTEST_CONFIG_NO_MULTITHREADING
#include <doctest/doctest.h>

int main() {
  doctest::Context context;
  context.setOption("no-colors", true);
  return context.run();
}
