#pragma once

/// What a program does with points and meshes that stream. Throws std::logic_error that says what
/// is not as promised.
void use_streams();
