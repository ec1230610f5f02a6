#include "material.h"
