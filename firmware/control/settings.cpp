#include <control/settings.hpp>
