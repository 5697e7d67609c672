fn $name(ray: Ray) -> CountedHit {
    let slack = ${places}_at(0u).slack;
    var best = $zero.hit;
    var primitives = 0u;
    var limit = ray.t_max;
    var w = $start(ray);
    loop {
        let next = $next(&w, limit);
        if (next.id == ${NONE}u) {
            break;
        }
        primitives = primitives + 1u;
        var candidate = $intersect(${prims_name}_at(next.id), next.ray)$path;
        candidate.prim_id = next.id;
        candidate.inst_id = next.inst;
        if ($is_within(candidate, ray) && $is_before(candidate, best)) {
            best = candidate;
            limit = $limit_behind(best.t, slack, ray.t_max);
        }
    }
    return CountedHit(best, Cost(w.tested, primitives));
}
