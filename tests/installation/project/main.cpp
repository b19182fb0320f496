#include <cstdio>

#include <inkwell/inkwell.hpp>

int main() {
  try {
    inkwell::Arm arm("virtual");
    const auto information = arm.information();
    std::printf("%s %d\n", information.firmware_version, information.is_virtual);
  } catch (const inkwell::Failure& failure) {
    std::printf("%s\n", failure.what());
    return 1;
  }
}
