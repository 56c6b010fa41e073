// A sun, and light from the side away from it: what a surface of a colour looks like that faces along n, a unit vector.
vec3 lit(vec3 paint, vec3 n)
{
    float sun = max(dot(n, vec3(0.47, 0.80, 0.37)), 0.0);
    float fill = max(dot(n, vec3(-0.70, 0.25, -0.67)), 0.0);
    return paint * (vec3(0.42, 0.44, 0.48) + 0.10 * n.y + sun * vec3(0.56, 0.52, 0.44) + fill * vec3(0.17, 0.20, 0.24));
}
