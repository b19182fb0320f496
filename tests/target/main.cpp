#define DOCTEST_CONFIG_IMPLEMENT
#define DOCTEST_CONFIG_NO_POSIX_SIGNALS
#define DOCTEST_CONFIG_NO_MULTITHREADING
#include <doctest/doctest.h>

/// The start-up code calls this function, because an ISO C++ program must not call main().
extern "C" int run_tests() {
  doctest::Context context;
  context.setOption("no-colors", true);
  return context.run();
}
