// Layers per pixel to a heat palette: black 0, blue 1, then cyan, green, yellow, red, and white from 32 on.
layout(location = 0) out vec4 colour;
layout(binding = 0) uniform sampler2D layers;

void main()
{
    const vec3 palette[7] = vec3[7](vec3(0.0), vec3(0.05, 0.10, 0.55), vec3(0.0, 0.65, 0.80), vec3(0.15, 0.75, 0.15),
                                    vec3(0.95, 0.90, 0.10), vec3(0.90, 0.15, 0.05), vec3(1.0));
    float n = texelFetch(layers, ivec2(gl_FragCoord.xy), 0).r;
    float at = n < 1.0 ? n : min(1.0 + log2(n), 6.0); // each doubling is one step
    int step = min(int(at), 5);
    colour = vec4(mix(palette[step], palette[step + 1], at - float(step)), 1.0);
}
