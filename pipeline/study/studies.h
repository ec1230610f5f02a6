/// One function a study: each measures on the bench, and fills in tables, plots and checks.
#pragma once

#include "pipeline/study/study_bench.h"

namespace trapeze {

void study_table1(StudyBench& bench, StudyResult& result);
void study_table2(StudyBench& bench, StudyResult& result);
void study_table3(StudyBench& bench, StudyResult& result);
void study_table4(StudyBench& bench, StudyResult& result);
void study_table5(StudyBench& bench, StudyResult& result);
void study_fig6(StudyBench& bench, StudyResult& result);
void study_fig9(StudyBench& bench, StudyResult& result);
void study_fig10(StudyBench& bench, StudyResult& result);
void study_growth(StudyBench& bench, StudyResult& result);
void study_msbvh(StudyBench& bench, StudyResult& result);
void study_mbkd(StudyBench& bench, StudyResult& result);
void study_dynamic(StudyBench& bench, StudyResult& result);
void study_structures(StudyBench& bench, StudyResult& result);

}  // namespace trapeze
