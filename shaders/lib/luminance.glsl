#ifndef GLIM_LIB_LUMINANCE
#define GLIM_LIB_LUMINANCE

// `radiance` is linear Rec.709.
float luminanceOf(vec3 radiance)
{
    return dot(radiance, vec3(0.2126, 0.7152, 0.0722));
}

#endif
