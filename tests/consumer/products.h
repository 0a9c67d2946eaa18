#pragma once

/// What a program has made of points and meshes. Throws std::logic_error that says what is not as
/// promised.
void make_products();
