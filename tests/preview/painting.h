// Paints to the end.
#pragma once
#include "fixtures.h"
#include "preview/painter.h"

namespace tyndall::test {
inline std::atomic<bool> never{false}; // cancelled

// All pictures until there is none to come.
inline std::vector<ShownPicture> paint_all(Painter& painter, const Request& request) {
    std::vector<ShownPicture> pictures;
    while (auto picture = paint(painter, request, never)) {
        EXPECT_EQ(picture->error, "");
        pictures.push_back(std::move(*picture));
        if (pictures.size() > 50) ADD_FAILURE() << "there is no end";
        if (pictures.size() > 50) break;
    }
    return pictures;
}
}
