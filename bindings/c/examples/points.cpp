/* The same from C++: c++ points.cpp $(pkg-config --cflags --libs strew) */

#include <cstdio>
#include <thread>

#include <strew.hpp>

int main() {
    strew::Library library;
    strew::Plan box = library.plan("bbox=0,0,10,10&spacing=1&seed=7");
    std::vector<double> xy = box.coordinates();
    std::printf("%zu points, the first at %.3f, %.3f\n", xy.size() / 2, xy[0], xy[1]);

    /* Threads share a library: each makes a chunk of its own. */
    const std::string forest = "spacing=2&seed=5&attributes=angle";
    std::vector<std::vector<float>> chunks(4);
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; i++)
        threads.emplace_back([&, i] { chunks[i] = library.chunk(forest, 64, i, 0).coordinates_f32(); });
    for (std::thread &thread : threads) thread.join();
    std::size_t points = 0;
    for (const std::vector<float> &chunk : chunks) points += chunk.size() / 2;
    std::printf("%zu points in 4 chunks\n", points);

    strew_point nearest = library.nearest("at=5,5&spacing=1&seed=7").at(0);
    strew_point again = library.point("spacing=1&seed=7", nearest.id[0], nearest.id[1]);
    std::printf("found again by its id: %s\n", nearest.x == again.x ? "yes" : "no");

    std::vector<double> ball = library.space("ball=5,5,5,3&spacing=1&seed=7").coordinates();
    strew_point center = library.space_nearest("at=5,5,5&spacing=1&seed=7").at(0);
    std::printf("%zu points in a ball, the nearest to its center %.3f away\n", ball.size() / 3, center.distance);

    try {
        library.plan("bbox=0,0,10,10&spacing=-1");
    } catch (const strew::Error &error) {
        std::printf("%s: %s\n", error.field.c_str(), error.what());
    }
}
