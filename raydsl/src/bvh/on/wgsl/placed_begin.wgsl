/// A walk that has yet to begin.
fn $name(ray: Ray) -> $walk_type {
    var w = $walk_type();
    $enter(&w, 0u, ray, ray.t_max);
    return w;
}
