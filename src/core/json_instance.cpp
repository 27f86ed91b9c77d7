#include "dcnn/core/json.h"

template class std::vector<nlohmann::ordered_json>;
template class nlohmann::basic_json<nlohmann::ordered_map>;
template class nlohmann::detail::serializer<nlohmann::ordered_json>;
