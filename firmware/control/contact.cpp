#include <control/contact.hpp>
