// The figures of a run, each described once for its tables, its JSON and its page.
#pragma once

#include "msgs/diagnostics.h"
#include "tools/replay/replay_result.h"
#include "tools/web/table.h"

namespace maploop::tools {

extern const web::Columns<Accuracy> accuracy_columns;
extern const web::Columns<fusion_score::Errors> error_columns;
extern const web::Columns<fusion_score::OutageEnd> outage_end_columns;
extern const web::Columns<fusion_score::ProtectionScore> protection_columns;
extern const web::Columns<vehicle::SensorReport> sensor_columns;
extern const web::Columns<vehicle::FaultCount> fault_columns;
extern const web::Columns<RefusalCount> refusal_columns;
extern const web::Columns<RingHealth> ring_columns;
extern const web::Columns<RealtimeSetting> setting_columns;
extern const web::Columns<SensorClock> clock_columns;

}  // namespace maploop::tools
