#include "viewer/painting/painting.h"

#include <gtest/gtest.h>

namespace tyndall::test {
std::vector<ShownPicture> paint_all(Painter& painter, const Request& request) {
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
