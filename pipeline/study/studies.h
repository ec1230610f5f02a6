/// One function a study: each measures on the bench, and fills in tables, plots and checks.
#pragma once

#include "pipeline/study/study_bench.h"

namespace trapeze {

#define TRAPEZE_STUDY(name, title, about, paper) void study_##name(StudyBench& bench, StudyResult& result);
#include "pipeline/study/studies.def"
#undef TRAPEZE_STUDY

}  // namespace trapeze
