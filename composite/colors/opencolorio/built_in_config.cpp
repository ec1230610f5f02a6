#include "composite/colors/opencolorio/built_in_config.h"

namespace trapeze {

namespace ocio = OCIO_NAMESPACE;

namespace {

constexpr const char* kLinear = "Linear Rec.709";

/// From encoded to linear (IEC 61966-2-1).
ocio::ConstTransformRcPtr srgb_curve() {
    const auto curve = ocio::ExponentWithLinearTransform::Create();
    constexpr double kGamma[4] = {2.4, 2.4, 2.4, 1}, kOffset[4] = {0.055, 0.055, 0.055, 0};
    curve->setGamma(kGamma);
    curve->setOffset(kOffset);
    return curve;
}

}  // namespace

ocio::ConstConfigRcPtr make_built_in_config() {
    const auto config = ocio::Config::Create()->createEditableCopy();

    const auto linear = ocio::ColorSpace::Create();
    linear->setName(kLinear);
    linear->addAlias("lin_rec709");
    linear->addAlias("linear");
    linear->setEncoding("scene-linear");
    config->addColorSpace(linear);

    const auto srgb = ocio::ColorSpace::Create();
    srgb->setName(kBuiltInView);
    srgb->addAlias("srgb_rec709");
    srgb->setEncoding("sdr-video");
    srgb->setTransform(srgb_curve(), ocio::COLORSPACE_DIR_TO_REFERENCE);
    config->addColorSpace(srgb);

    const auto raw = ocio::ColorSpace::Create();
    raw->setName("Raw");
    raw->setEncoding("data");
    raw->setIsData(true);
    config->addColorSpace(raw);

    config->setRole(ocio::ROLE_SCENE_LINEAR, kLinear);
    config->setRole(ocio::ROLE_DEFAULT, kLinear);
    config->addDisplayView(kBuiltInDisplay, kBuiltInView, kBuiltInView, "");
    config->addDisplayView(kBuiltInDisplay, "Raw", "Raw", "");
    return config;
}

}  // namespace trapeze
