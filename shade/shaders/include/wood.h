#include "oak.h"
