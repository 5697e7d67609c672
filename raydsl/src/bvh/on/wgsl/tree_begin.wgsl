/// A traversal that has yet to begin.
fn $name(ray: Ray$parameter) -> Traversal {
    var w = Traversal();
    if (params.len_of_$nodes == 0u || !$is_finite(ray)) {
        return w;
    }
    let node = ${nodes}_at($first);
    let s = $slabs(ray, node.min, node.max, $slack, 0.0);
    w.lower = s.lower;
    w.upper = s.upper;
    w.inverse = s.inverse;
    let enter = $enter_leave(s, node.min, node.max, ray.t_min, ray.t_max);
    w.nodes[0] = $first;
    w.enters[0] = enter.x;
    w.top = select(0u, 1u, enter.x <= enter.y);
    return w;
}
