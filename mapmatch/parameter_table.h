// The parameters of the matcher and of its feedback described: [mapmatch] and [feedback] of the
// configuration.
#pragma once

#include "mapmatch/feedback_parameters.h"
#include "mapmatch/match_parameters.h"
#include "msgs/parameter.h"

namespace maploop::mapmatch {

ParameterTable<MatchParameters> parameter_table(const MatchParameters&);
ParameterTable<FeedbackParameters> parameter_table(const FeedbackParameters&);

}  // namespace maploop::mapmatch
