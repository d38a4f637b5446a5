// The actions of the server behind `tailwater view` that use other commands of the program.
#pragma once

#include <filesystem>
#include <vector>

#include "server/view_server.h"

namespace tailwater {

/// `sweeps`: the folders of the sweeps whose members are shown.
ViewActions view_actions(const ViewContent& content, const std::vector<std::filesystem::path>& sweeps);

}  // namespace tailwater
