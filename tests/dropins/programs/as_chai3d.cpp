// Makes the same calls in the same order as CHAI3D 3. Loads both drop-in libraries with dlopen() and resolves every
// symbol. Makes one deliberate error. Prints one line per result. The optional argument is a rightward force in
// newtons.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "tests/dropins/hdapi.hpp"

namespace {

void* library = nullptr;
constexpr HHD no_device = 77;

template <class Function>
Function* symbol(const char* name) {
  void* found = dlsym(library, name);
  if (found == nullptr) {
    std::printf("missing %s\n", name);
    std::exit(2);
  }
  return reinterpret_cast<Function*>(found);
}

}  // namespace

int main(int count, char** arguments) {
  if (dlopen("libHD.so", RTLD_LAZY | RTLD_GLOBAL) == nullptr ||
      (library = dlopen("libhdPhantom.so", RTLD_LAZY | RTLD_GLOBAL)) == nullptr) {
    std::printf("no library: %s\n", dlerror());
    return 2;
  }
  using Read3 = int(int, double*, double*, double*);
  using Write3 = int(int, const double*, const double*, const double*);
  const auto get_count = symbol<int()>("hdPhantomGetNumDevices");
  const auto open = symbol<int(int)>("hdPhantomOpen");
  const auto close = symbol<int(int)>("hdPhantomClose");
  const auto get_position = symbol<Read3>("hdPhantomGetPosition");
  symbol<Read3>("hdPhantomGetLinearVelocity");
  const auto get_rotation =
      symbol<int(int, double*, double*, double*, double*, double*, double*, double*, double*, double*)>(
          "hdPhantomGetRotation");
  const auto get_buttons = symbol<int(int)>("hdPhantomGetButtons");
  symbol<Write3>("hdPhantomSetForce");
  symbol<Write3>("hdPhantomSetTorque");
  const auto set_force_and_torque =
      symbol<int(int, const double*, const double*, const double*, const double*, const double*, const double*)>(
          "hdPhantomSetForceAndTorque");
  const auto get_radius = symbol<int(int, double*)>("hdPhantomGetWorkspaceRadius");
  const auto get_type = symbol<int(int, char*)>("hdPhantomGetType");
  symbol<void()>("hdPhantomStartServo");
  const auto stop_servo = symbol<void()>("hdPhantomStopServo");

  const int devices = get_count();
  std::printf("devices %d\n", devices);
  double x = 0, y = 0, z = 0, radius = 0, r[9];
  char type[255] = "";
  std::printf("early %d\n", get_position(0, &x, &y, &z));
  if (devices < 1) return 1;
  const int has_radius = get_radius(0, &radius), has_type = get_type(0, type);
  std::printf("radius %d %.4f\ntype %d %s\n", has_radius, radius, has_type, type);
  std::printf("open %d %d\n", open(devices), open(0));
  symbol<decltype(hdEndFrame)>("hdEndFrame")(no_device);  // a deliberate error
  const double force = count > 1 ? std::atof(arguments[1]) : 0.0, none = 0.0;
  int refused = 0;
  for (int i = 0; i < 1000; ++i) refused += set_force_and_torque(0, &none, &force, &none, &none, &none, &none) != 0;
  std::printf("refused %d\n", refused);
  const int sees = get_position(0, &x, &y, &z);
  std::printf("position %d %.6f %.6f %.6f\n", sees, x, y, z);
  const int turns = get_rotation(0, r, r + 1, r + 2, r + 3, r + 4, r + 5, r + 6, r + 7, r + 8);
  std::printf("rotation %d %.3f %.3f %.3f\n", turns, r[0], r[4], r[8]);
  std::printf("buttons %d\n", get_buttons(0));
  const auto error = symbol<decltype(hdGetError)>("hdGetError")();
  std::printf("error %#x %u\n", error.errorCode, error.hHD);
  std::printf("close %d\n", close(0));
  stop_servo();
  std::printf("late %d\n", get_position(0, &x, &y, &z));
  return 0;
}
