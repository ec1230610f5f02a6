# The headers that a plugin may include, sample/plugin.h and what it needs, from the repository's root. Installed below
# include/trapeze in the same folders. tests/plugin_test.cpp builds the example with these alone.
set(TRAPEZE_PLUGIN_HEADERS
    core/diagnostics.h
    core/grid.h
    core/hit_buffer.h
    core/hit_micropolygon.h
    core/math.h
    core/motion_keys.h
    core/pixel_rect.h
    core/rays.h
    core/samples.h
    core/scene/aperture.h
    core/scene/camera.h
    core/scene/layer_limit.h
    core/scene/light_shape.h
    core/scene/parameters.h
    core/scene/poses.h
    core/scene/render_context.h
    core/scene/scene.h
    core/scene/shapes.h
    core/scene/user_values.h
    core/stats.h
    sample/build_memory.h
    sample/hit_lists.h
    sample/loose_hits.h
    sample/names/method_spec.h
    sample/patterns/lens_outline.h
    sample/patterns/lens_shape.h
    sample/patterns/sample_levels.h
    sample/patterns/sample_pattern.h
    sample/patterns/strata.h
    sample/plugin.h
    sample/sample_scratch.h
    sample/swept_bound.h
    sample/visibility.h
    sample/visibility_methods.def)

# How a plugin is compiled: products are not fused into sums, as in the program. What makes a shared library of it, -fPIC
# and -shared, its author says: Debian keeps such flags out of .pc files (lintian, pkg-config-bad-directive).
set(TRAPEZE_PLUGIN_OPTIONS "-std=c++20 -ffp-contract=off")

# trapeze_takes_plugins(TARGET): the program shows to plugins what is not in those headers [decision 0040].
function(trapeze_takes_plugins target)
    set(symbols ${PROJECT_SOURCE_DIR}/cmake/plugin_symbols.list)
    target_link_options(${target} PRIVATE "-Wl,--export-dynamic-symbol-list=${symbols}")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${symbols})
endfunction()
