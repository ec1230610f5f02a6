#include "rmannotes.sl"
