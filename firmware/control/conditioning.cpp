#include <control/conditioning.hpp>
